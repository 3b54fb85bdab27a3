# cmake --install: headers, both libraries, the programs, examples, shader functions for hosts, the licence, and packages for
# find_package and pkg-config. The tree can be moved: nothing in it names the prefix.
include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/afterglow)

install(DIRECTORY include/afterglow DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(AFTERGLOW_IMPORTER)
  install(TARGETS afterglow_import DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/afterglow)
endif()
install(FILES LICENSE THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN *.[ch])
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Headers for a host's own shaders: `glslc -DAG_GLSL=1 -I <prefix>/share/afterglow/glsl`. Paths are those of src/.
foreach(file core/shared.h core/sh.glsl frame/frame_shared.h frame/octahedral.glsl frame/probes.glsl
    techniques/common/probes/depth_shared.h techniques/common/probes/lookup.glsl)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES src/${file} DESTINATION ${CMAKE_INSTALL_DATADIR}/afterglow/glsl/${folder})
endforeach()
if(TARGET afterglow)
  install(TARGETS afterglow)
  install(FILES ${PROJECT_BINARY_DIR}/manual/afterglow.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES app/completions/afterglow.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME afterglow)
  install(FILES app/completions/_afterglow DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  install(FILES app/completions/afterglow.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()

if(TARGET afterglow_mpi)
  install(TARGETS afterglow_mpi)
endif()

# Two exports, since only users of the static library need the third-party libraries.
foreach(kind shared static)
  install(TARGETS afterglow_${kind} EXPORT afterglow_${kind})
  install(EXPORT afterglow_${kind} NAMESPACE afterglow:: FILE afterglow-${kind}.cmake DESTINATION ${package})
endforeach()
configure_package_config_file(cmake/afterglow-config.cmake.in ${PROJECT_BINARY_DIR}/afterglow-config.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/afterglow-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/afterglow-config.cmake ${PROJECT_BINARY_DIR}/afterglow-config-version.cmake
  DESTINATION ${package})

# pkg-config names of the third-party libraries that the static library needs.
set(AFTERGLOW_PC_REQUIRES vulkan)
set(pc_libraries "")
if(AFTERGLOW_FILES)
  string(APPEND AFTERGLOW_PC_REQUIRES " jansson libpng libjpeg OpenEXR")
endif()
if(AFTERGLOW_BAKES)
  string(APPEND AFTERGLOW_PC_REQUIRES " qhull_r")
  # As flags: required by name, OpenBLAS would add the Fortran library of its static version.
  list(APPEND pc_libraries ${LAPACKE_LDFLAGS} ${OPENBLAS_LDFLAGS})
endif()
if(AFTERGLOW_OPENMP)
  list(APPEND pc_libraries -lgomp)
endif()
if(AFTERGLOW_TRACE)
  list(APPEND pc_libraries -lembree${EMBREE_MAJOR})
endif()
list(JOIN pc_libraries " " AFTERGLOW_PC_LIBRARIES)
# Path from <libdir>/pkgconfig to the prefix, so that an installed tree can be moved.
file(RELATIVE_PATH AFTERGLOW_PC_UP /prefix/${CMAKE_INSTALL_LIBDIR} /prefix)
foreach(name afterglow afterglow-static)
  configure_file(cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
