# Trials that every technique of a role stands: they read the registry or have a row for each.
add_library(ag_test_light_trial STATIC techniques/trials/light_trial.c techniques/trials/light_trial_scenes.c techniques/trials/plane_trial.c techniques/trials/share_trial.c)
target_link_libraries(ag_test_light_trial PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques ag_trace PRIVATE afterglow_flags m)
add_library(ag_test_paint STATIC techniques/trials/paint_fixture.c)
target_link_libraries(ag_test_paint PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques PRIVATE afterglow_flags m)

ag_technique_tests(trials/emission trials/invariants trials/smoke trials/visibility)
ag_test(techniques/trials/paint USES techniques LIBRARIES ag_test_paint)
foreach(name ceiling_light door environment light mirror objects outdoors planes probes spots street window)
  ag_test(techniques/trials/${name} USES techniques LIBRARIES ag_test_light_trial)
endforeach()
ag_shaders_for(test_techniques_trials techniques_test_shaders.h ${CMAKE_CURRENT_LIST_DIR}/shaders)

# Every option of every technique: minutes alone, more beside others.
set_tests_properties(techniques.trials.environment techniques.trials.invariants techniques.trials.light
  techniques.trials.mirror techniques.trials.planes techniques.trials.smoke PROPERTIES TIMEOUT 900)
