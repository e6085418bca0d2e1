# What `cmake --install` and the Debian packages hold: the program, with its manual and what bash completes of it; and,
# for development, find_package(pbnbrdf [COMPONENTS core sources database metrics render report]) and pkg-config's pbnbrdf.pc.
include(CMakePackageConfigHelpers)

install(TARGETS pbnbrdf_program RUNTIME COMPONENT program)
install(DIRECTORY problems DESTINATION ${CMAKE_INSTALL_DATADIR}/pbnbrdf COMPONENT program)
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/pbnbrdf COMPONENT program)

# The program writes its own manual; it can't where it is built for another machine and there is no emulator.
if(NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR)
  find_program(GZIP gzip)
  set(manual ${PROJECT_BINARY_DIR}/pbnbrdf.1)
  set(completion ${PROJECT_BINARY_DIR}/pbnbrdf.bash)
  add_custom_command(OUTPUT ${manual}.gz ${completion}
                     COMMAND pbnbrdf_program --manual > ${manual}
                     COMMAND ${GZIP} -9nf ${manual}
                     COMMAND pbnbrdf_program --completion > ${completion}
                     DEPENDS pbnbrdf_program VERBATIM)
  add_custom_target(pbnbrdf_manual ALL DEPENDS ${manual}.gz ${completion})
  install(FILES ${manual}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
  install(FILES ${completion} RENAME pbnbrdf COMPONENT program
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
endif()

install(DIRECTORY include/pbnbrdf TYPE INCLUDE)
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpbnbrdf-dev)
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
string(REGEX REPLACE "[^/]+" ".." up ${CMAKE_INSTALL_LIBDIR}/pkgconfig)  # from there to the prefix
configure_file(cmake/pbnbrdf.pc.in pbnbrdf.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pbnbrdf.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# cpack -G DEB: pbnbrdf and libpbnbrdf-dev.
set(CPACK_PACKAGE_NAME pbnbrdf)
set(CPACK_PACKAGE_CONTACT "The pbnbrdf authors <pbnbrdf@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "fits small neural BRDFs that obey physics to measurements")
set(CPACK_PACKAGE_DESCRIPTION
    "Turns a measured BRDF (MERL, RGL, Cornell, Zemax, CSV and others) into a small
network that is reciprocal, non-negative and conserves energy, by nonlinear
least squares; measures, renders and exports it.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pbnbrdf)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpbnbrdf-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libceres-dev, libeigen3-dev, libhwy-dev, libtbb-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libhdf5-dev, libzip-dev, libopenexr-dev, libpng-dev, libembree-dev")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "${CPACK_PACKAGE_DESCRIPTION}\nThis package has the C++ library.")
include(CPack)
