# cmake --install: headers, both libraries, the program, afterglow.pc for pkg-config and a package for find_package.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/afterglow)

install(DIRECTORY include/afterglow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS afterglow afterglow_static)
install(TARGETS afterglow_import DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/afterglow)
install(TARGETS afterglow_shared EXPORT afterglow)
install(EXPORT afterglow NAMESPACE afterglow:: FILE afterglow-config.cmake DESTINATION ${package})

write_basic_package_version_file(${CMAKE_BINARY_DIR}/afterglow-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/afterglow-config-version.cmake DESTINATION ${package})

# pkg-config names of the third-party libraries that the static library needs.
set(AFTERGLOW_PC_REQUIRES "jansson libxxhash libpng OpenEXR spirv-cross-c-shared vulkan")
# As flags: required by name, OpenBLAS would add the Fortran library of its static version.
list(JOIN OPENBLAS_LDFLAGS " " AFTERGLOW_PC_OPENBLAS)
list(JOIN LAPACKE_LDFLAGS " " AFTERGLOW_PC_LAPACKE)
# Path from <libdir>/pkgconfig to the prefix, so that an installed tree can be moved.
file(RELATIVE_PATH AFTERGLOW_PC_UP /prefix/${CMAKE_INSTALL_LIBDIR} /prefix)
configure_file(cmake/afterglow.pc.in ${CMAKE_BINARY_DIR}/afterglow.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/afterglow.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
