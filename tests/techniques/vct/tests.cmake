ag_technique_tests(vct/bounces vct/clips vct/clip_light vct/edge_cases vct/hidden vct/history vct/kept_light
  vct/light vct/octree_bricks vct/octree_nodes vct/screen vct/small_emitters vct/specular vct/storage vct/temporal
  vct/vctao vct/voxels)
ag_test(techniques/vct/open_plane USES techniques LIBRARIES ag_test_light_trial ag_test_frame_fixture)
# It compares times.
set_tests_properties(techniques.vct.screen PROPERTIES RUN_SERIAL TRUE)
