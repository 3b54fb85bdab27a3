add_library(ag_test_techniques STATIC techniques/baked_fixture.c techniques/damage_fixture.c techniques/gi_baked.c
  techniques/gi_fixture.c techniques/paint_fixture.c techniques/technique_rules.c)
target_link_libraries(ag_test_techniques PUBLIC ag_test_frame_fixture ag_techniques PRIVATE afterglow_flags m)

add_library(ag_test_light_trial STATIC techniques/light_trial.c techniques/light_trial_scenes.c)
target_link_libraries(ag_test_light_trial PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques ag_trace PRIVATE afterglow_flags m)

# Tests of frames of a technique.
function(ag_technique_tests)
  foreach(name ${ARGN})
    ag_test(techniques/${name} USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
  endforeach()
endfunction()

ag_technique_tests(emission gi_bake gi_spec paint technique_invariants technique_smoke visibility)
target_compile_definitions(test_techniques_gi_spec PRIVATE TECHNIQUES_DIR="${CMAKE_SOURCE_DIR}/src/techniques")
ag_test(techniques/kept USES techniques)
ag_test(techniques/sample_sets USES techniques LIBRARIES ag_samples)
ag_test(techniques/light_trials USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/environment_trials USES techniques LIBRARIES ag_test_light_trial ag_test_techniques ag_test_frame_fixture)
ag_test(techniques/environment_mirror USES techniques LIBRARIES ag_test_light_trial ag_test_techniques ag_test_frame_fixture)
ag_test(techniques/probe_trials USES techniques LIBRARIES ag_test_light_trial ag_test_techniques ag_test_frame_fixture)
ag_shaders_for(test_techniques_probe_trials techniques_test_shaders.h ${CMAKE_CURRENT_LIST_DIR}/shaders)

file(GLOB tests_of_techniques CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*/tests.cmake)
foreach(file ${tests_of_techniques})
  include(${file})
endforeach()

# Every option of every technique: minutes alone, more beside others.
set_tests_properties(techniques.technique_smoke techniques.technique_invariants techniques.light_trials
  techniques.environment_trials techniques.environment_mirror PROPERTIES TIMEOUT 900)
