add_library(ag_test_studio STATIC ${CMAKE_CURRENT_SOURCE_DIR}/frame/studio.c)
target_link_libraries(ag_test_studio PUBLIC ag_test_gpu ag_frame PRIVATE afterglow_flags)
ag_shaders_for(ag_test_studio frame_test_shaders.h ${CMAKE_CURRENT_SOURCE_DIR}/frame/shaders)

foreach(name direct emitters frame gbuffer kept_maps rsm scene_triangles shadow)
  ag_test(frame/${name} USES frame LIBRARIES ag_test_studio)
endforeach()
