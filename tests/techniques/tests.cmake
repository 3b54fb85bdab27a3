add_library(ag_test_techniques STATIC techniques/bake_bytes.c techniques/baked_fixture.c techniques/damage_fixture.c
  techniques/gi_baked.c techniques/gi_fixture.c techniques/kept_bake.c techniques/technique_rules.c)
target_link_libraries(ag_test_techniques PUBLIC ag_test_frame_fixture ag_techniques PRIVATE afterglow_flags m)

# Tests of frames of a technique.
function(ag_technique_tests)
  foreach(name ${ARGN})
    ag_test(techniques/${name} USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
  endforeach()
endfunction()

ag_technique_tests(gi_bake gi_spec)
target_compile_definitions(test_techniques PRIVATE TECHNIQUES_DIR="${CMAKE_SOURCE_DIR}/src/techniques")

file(GLOB tests_of_techniques CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*/tests.cmake)
foreach(file ${tests_of_techniques})
  include(${file})
endforeach()
