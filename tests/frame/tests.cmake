add_library(ag_test_frame_fixture STATIC ${CMAKE_CURRENT_SOURCE_DIR}/frame/frame_fixture.c)
target_link_libraries(ag_test_frame_fixture PUBLIC ag_test_gpu ag_frame PRIVATE afterglow_flags)
ag_shaders_for(ag_test_frame_fixture frame_test_shaders.h ${CMAKE_CURRENT_SOURCE_DIR}/frame/shaders)

foreach(name direct direct_irradiance emitters environment frame gbuffer ids cached_maps rsm scene_triangles shadow shadow_blocks)
  ag_test(frame/${name} USES frame LIBRARIES ag_test_frame_fixture)
endforeach()
