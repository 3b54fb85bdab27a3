add_library(ag_test_mrt STATIC techniques/mrt/mrt_fixture.c techniques/mrt/mrt_bake_fixture.c)
target_link_libraries(ag_test_mrt PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
foreach(name bake_file dictionary interfaces shapes transfer tubes)
  ag_test(techniques/mrt/${name} USES techniques LIBRARIES ag_test_mrt)
endforeach()
# Files are untrusted input: `check` runs tests with this label under the sanitizers.
set_tests_properties(techniques.mrt.bake_file PROPERTIES LABELS "techniques;bake")

add_library(ag_test_mrt_map STATIC techniques/mrt/mrt_map_fixture.c techniques/mrt/mrt_operators_fixture.c)
target_link_libraries(ag_test_mrt_map PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
foreach(name atlas blocks geometry level maps options solver)
  ag_test(techniques/mrt/${name} USES techniques LIBRARIES ag_test_mrt_map)
endforeach()
foreach(name light probes retrace)
  ag_test(techniques/mrt/${name} USES techniques LIBRARIES ag_test_mrt ag_test_mrt_map)
endforeach()

add_library(ag_test_mrt_runtime STATIC techniques/mrt/mrt_runtime_fixture.c)
target_link_libraries(ag_test_mrt_runtime PUBLIC ag_test_gpu ag_test_mrt ag_test_mrt_map PRIVATE afterglow_flags m)
ag_test(techniques/mrt/runtime USES techniques LIBRARIES ag_test_mrt_runtime)

ag_technique_tests(mrt/frame mrt/places mrt/drt_frame)
ag_test(techniques/mrt/drt_delta USES techniques)
ag_test(techniques/mrt/drt_pillars USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
