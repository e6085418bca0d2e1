# find_package(pbnbrdf [COMPONENTS core sources metrics render]) for those who link the library.
include(CMakePackageConfigHelpers)
install(TARGETS pbnbrdf_program RUNTIME)
install(DIRECTORY include/pbnbrdf TYPE INCLUDE)
install(DIRECTORY problems DESTINATION ${CMAKE_INSTALL_DATADIR}/pbnbrdf)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pbnbrdf)
get_property(components GLOBAL PROPERTY PBNBRDF_COMPONENTS)
foreach(component ${components})
  install(EXPORT pbnbrdf-${component} NAMESPACE pbnbrdf:: DESTINATION ${package_dir})
endforeach()
configure_package_config_file(cmake/pbnbrdf-config.cmake.in pbnbrdf-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(pbnbrdf-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pbnbrdf-config.cmake
              ${PROJECT_BINARY_DIR}/pbnbrdf-config-version.cmake DESTINATION ${package_dir})
