# find_package(pbnbrdf) for those who link the library.
include(CMakePackageConfigHelpers)
get_property(modules GLOBAL PROPERTY PBNBRDF_MODULES)
install(TARGETS ${modules} pbnbrdf_all EXPORT pbnbrdf-targets)
install(TARGETS pbnbrdf_program RUNTIME)
install(DIRECTORY include/pbnbrdf TYPE INCLUDE)
install(DIRECTORY problems DESTINATION ${CMAKE_INSTALL_DATADIR}/pbnbrdf)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pbnbrdf)
install(EXPORT pbnbrdf-targets NAMESPACE pbnbrdf:: DESTINATION ${package_dir})
configure_package_config_file(cmake/pbnbrdf-config.cmake.in pbnbrdf-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(pbnbrdf-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pbnbrdf-config.cmake
              ${PROJECT_BINARY_DIR}/pbnbrdf-config-version.cmake DESTINATION ${package_dir})
