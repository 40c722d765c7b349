# OpenImageIO's library alone. Debian's OpenImageIOConfig.cmake fails unless the package of its
# command-line tools is installed too.
find_path(OpenImageIOLibrary_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIOLibrary_LIBRARY OpenImageIO)
find_library(OpenImageIOLibrary_Util_LIBRARY OpenImageIO_Util)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIOLibrary REQUIRED_VARS
    OpenImageIOLibrary_INCLUDE_DIR OpenImageIOLibrary_LIBRARY OpenImageIOLibrary_Util_LIBRARY)
if(OpenImageIOLibrary_FOUND AND NOT TARGET OpenImageIO::Library)
    add_library(OpenImageIO::Library UNKNOWN IMPORTED)
    # Its headers switch fmt's exceptions off for the whole program unless told otherwise.
    set_target_properties(OpenImageIO::Library PROPERTIES
        IMPORTED_LOCATION ${OpenImageIOLibrary_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${OpenImageIOLibrary_INCLUDE_DIR}
        INTERFACE_LINK_LIBRARIES ${OpenImageIOLibrary_Util_LIBRARY}
        INTERFACE_COMPILE_DEFINITIONS FMT_EXCEPTIONS=1)
endif()
mark_as_advanced(OpenImageIOLibrary_INCLUDE_DIR OpenImageIOLibrary_LIBRARY
    OpenImageIOLibrary_Util_LIBRARY)
