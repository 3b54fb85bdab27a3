add_library(ag_test_gpu_shaders STATIC)
target_link_libraries(ag_test_gpu_shaders PUBLIC ag_gpu)
ag_shaders_for(ag_test_gpu_shaders gpu_test_shaders.h ${CMAKE_CURRENT_SOURCE_DIR}/gpu/shaders)

foreach(name dispatch objects reload render scope transfer)
  ag_test(gpu/${name} USES gpu LIBRARIES ag_test_gpu ag_test_gpu_shaders)
endforeach()
# These look inside, or make Vulkan objects of their own.
foreach(name alias device hazard memory pipeline_pool)
  ag_test(gpu/${name} USES gpu LIBRARIES ag_test_gpu ag_test_gpu_shaders Vulkan::Vulkan)
endforeach()
ag_test(gpu/adopt USES gpu LIBRARIES ag_test_gpu ag_test_gpu_shaders ag_test_own_device)
# It compares times.
set_tests_properties(gpu.scope PROPERTIES RUN_SERIAL TRUE)
