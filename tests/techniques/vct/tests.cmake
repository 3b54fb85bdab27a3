add_library(ag_test_vct STATIC techniques/vct/svo_tree.c techniques/vct/vct_fixture.c techniques/vct/vct_twin.c
  techniques/vct/vct_voxel_count.c)
target_link_libraries(ag_test_vct PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques PRIVATE afterglow_flags m)
foreach(name bounces clips clip_light edge_cases hidden history kept_light light octree_bricks octree_nodes screen
    small_emitters specular steps storage temporal vctao voxels)
  ag_test(techniques/vct/${name} USES techniques LIBRARIES ag_test_vct)
endforeach()
ag_test(techniques/vct/open_plane USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/vct/large_scene USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/vct/walls USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
ag_test(techniques/vct/double_sided USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
# Pipelines of many grids: minutes alone, more beside others.
set_tests_properties(techniques.vct.clip_light PROPERTIES TIMEOUT 900)
# It compares times.
set_tests_properties(techniques.vct.screen PROPERTIES RUN_SERIAL TRUE)
