# The GL Utility library, whose polygon tessellator triangulates faces. CMake's own FindOpenGL asks
# for GLX and EGL as well.
find_path(GLU_INCLUDE_DIR GL/glu.h)
find_library(GLU_LIBRARY GLU)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GLU REQUIRED_VARS GLU_INCLUDE_DIR GLU_LIBRARY)
if(GLU_FOUND AND NOT TARGET GLU::GLU)
    add_library(GLU::GLU UNKNOWN IMPORTED)
    set_target_properties(GLU::GLU PROPERTIES IMPORTED_LOCATION ${GLU_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${GLU_INCLUDE_DIR})
endif()
mark_as_advanced(GLU_INCLUDE_DIR GLU_LIBRARY)
