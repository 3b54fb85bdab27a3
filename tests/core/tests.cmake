foreach(name arena file ggx_albedo hash host linalg option parallel process rng sampling saturate sh temporary text vec)
  ag_test(core/${name} USES core)
endforeach()

# The GLSL twin, called by a test shader.
add_library(ag_test_core_shaders STATIC)
target_link_libraries(ag_test_core_shaders PUBLIC ag_gpu)
ag_shaders_for(ag_test_core_shaders core_test_shaders.h ${CMAKE_CURRENT_SOURCE_DIR}/core/shaders)
ag_test(core/twins USES core gpu LIBRARIES ag_test_gpu ag_test_core_shaders LABELS gpu)
