add_library(ag_test_techniques STATIC techniques/gi_fixture.c techniques/geometry_fixture.c techniques/geometry_twin.c techniques/lpv_fixture.c
  techniques/lpv_twin.c techniques/lpv_twin_closed.c techniques/lpv_twin_product.c techniques/mesh_fixture.c techniques/rsm_fixture.c
  techniques/svo_tree.c techniques/vct_fixture.c techniques/vct_twin.c techniques/vct_voxel_count.c techniques/vo_fixture.c)
target_link_libraries(ag_test_techniques PUBLIC ag_test_frame_fixture ag_techniques PRIVATE afterglow_flags m)

add_library(ag_test_light_trial STATIC techniques/light_trial.c techniques/light_trial_scenes.c)
target_link_libraries(ag_test_light_trial PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques ag_trace PRIVATE afterglow_flags m)

foreach(name emission gi_bake gi_spec lpv_bounce lpv_cascades lpv_flux lpv_geometry_maps lpv_geometry_scene lpv_history lpv_math lpv_occlusion lpv_sky lpv_twin
    technique_invariants technique_smoke vct_bounces vct_clips vct_clip_light vct_small_emitters vct_light vct_kept_light vct_edge_cases vct_hidden vct_screen vct_specular vct_storage vct_temporal vct_history vct_voxels visibility vo
    vct_octree_nodes vct_octree_bricks vctao)
  ag_test(techniques/${name} USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
endforeach()
target_compile_definitions(test_techniques_gi_spec PRIVATE TECHNIQUES_DIR="${CMAKE_SOURCE_DIR}/src/techniques")
add_library(ag_test_mrt STATIC techniques/mrt_fixture.c techniques/mrt_bake_fixture.c)
target_link_libraries(ag_test_mrt PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
foreach(name bake_file dictionary interfaces shapes transfer tubes)
  ag_test(techniques/mrt_${name} USES techniques LIBRARIES ag_test_mrt)
endforeach()
# Files are untrusted input: `check` runs tests with this label under the sanitizers.
set_tests_properties(techniques.mrt_bake_file PROPERTIES LABELS "techniques;bake")
ag_test(techniques/sample_sets USES techniques LIBRARIES ag_samples)
# Every option of every technique, or pipelines of many grids: minutes alone, more beside others.
ag_test(techniques/light_trials USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/vct_open_plane USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
set_tests_properties(techniques.technique_smoke techniques.technique_invariants techniques.vct_clip_light techniques.light_trials PROPERTIES TIMEOUT 900)
add_library(ag_test_mrt_map STATIC techniques/mrt_map_fixture.c techniques/mrt_operators_fixture.c)
target_link_libraries(ag_test_mrt_map PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
foreach(name atlas blocks geometry level maps options solver)
  ag_test(techniques/mrt_${name} USES techniques LIBRARIES ag_test_mrt_map)
endforeach()
add_library(ag_test_mrt_runtime STATIC techniques/mrt_runtime_fixture.c)
target_link_libraries(ag_test_mrt_runtime PUBLIC ag_test_gpu ag_test_mrt ag_test_mrt_map PRIVATE afterglow_flags m)
ag_test(techniques/mrt_runtime USES techniques LIBRARIES ag_test_mrt_runtime)
foreach(name light probes retrace)
  ag_test(techniques/mrt_${name} USES techniques LIBRARIES ag_test_mrt ag_test_mrt_map)
endforeach()
ag_test(techniques/drt_delta USES techniques)
ag_test(techniques/drt_frame USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
ag_test(techniques/drt_pillars USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/mrt_frame USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
ag_test(techniques/mrt_places USES techniques LIBRARIES ag_test_techniques ag_test_frame_fixture)
# It compares times.
set_tests_properties(techniques.vct_screen PROPERTIES RUN_SERIAL TRUE)
