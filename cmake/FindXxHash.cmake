# xxHash's header alone, which holds the whole library: nothing is linked, so that an installed
# penumbra does not ask for it again. Debian's package has no CMake files. Debug builds do without its
# always_inline: GCC does not inline its kernels at -Og, and calls that an error.
find_path(XxHash_INCLUDE_DIR xxhash.h)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(XxHash REQUIRED_VARS XxHash_INCLUDE_DIR)
if(XxHash_FOUND AND NOT TARGET XxHash::XxHash)
    add_library(XxHash::XxHash INTERFACE IMPORTED)
    set_target_properties(XxHash::XxHash PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES ${XxHash_INCLUDE_DIR}
        INTERFACE_COMPILE_DEFINITIONS "XXH_INLINE_ALL;$<$<CONFIG:Debug>:XXH_NO_INLINE_HINTS=1>")
endif()
mark_as_advanced(XxHash_INCLUDE_DIR)
