include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/penumbra)
configure_package_config_file(cmake/penumbraConfig.cmake.in penumbraConfig.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(penumbraConfigVersion.cmake COMPATIBILITY SameMinorVersion)

install(TARGETS penumbra EXPORT penumbraTargets FILE_SET HEADERS)
install(TARGETS penumbra_imageio penumbra_draco LIBRARY DESTINATION ${module_dir})
install(EXPORT penumbraTargets NAMESPACE penumbra:: DESTINATION ${package_dir})
install(FILES ${PROJECT_BINARY_DIR}/penumbraConfig.cmake
    ${PROJECT_BINARY_DIR}/penumbraConfigVersion.cmake cmake/FindGLU.cmake
    cmake/FindOpenCVCore.cmake DESTINATION ${package_dir})
if(TARGET penumbra_cli)
    install(TARGETS penumbra_cli)
endif()
