include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/terrane)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/terraneConfig.cmake.in
  ${PROJECT_BINARY_DIR}/terraneConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/terraneConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/terraneConfig.cmake
              ${PROJECT_BINARY_DIR}/terraneConfigVersion.cmake
        DESTINATION ${package_dir})
install(EXPORT terraneTargets NAMESPACE terrane:: DESTINATION ${package_dir})
