# The public functions, through the public headers alone.
foreach(name abi arguments context scene catalogue reference)
  ag_test(api/${name} USES api)
endforeach()
add_library(ag_test_renderer_fixture STATIC ${CMAKE_CURRENT_LIST_DIR}/renderer_fixture.c)
target_link_libraries(ag_test_renderer_fixture PUBLIC ag_test_gpu ag_test_own_device ag_api PRIVATE afterglow_flags)
ag_test(api/odd_scenes USES api LIBRARIES ag_test_gpu)
ag_test(api/bake USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/bake_run USES api LIBRARIES ag_test_renderer_fixture)
target_sources(test_api_bake_run PRIVATE $<TARGET_OBJECTS:ag_test_sample_registry>)
ag_test(api/probes USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/renderer USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/picking USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/display USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/pipeline_cache USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/set_gi USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/layer_handles USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/host_gbuffer USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/vulkan USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/changes USES api LIBRARIES ag_test_renderer_fixture)
ag_test(api/textures USES api LIBRARIES ag_test_renderer_fixture)
target_sources(test_api_textures PRIVATE ${CMAKE_CURRENT_LIST_DIR}/scene_copy.c)
ag_test(api/frames_in_flight USES api LIBRARIES ag_test_renderer_fixture)

# Only ag_… is to be seen from outside. (Sanitizers add names of their own.)
if(NOT AFTERGLOW_SANITIZE)
  add_test(NAME api.exports
    COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/exports.sh $<TARGET_FILE:afterglow_shared> ${CMAKE_SOURCE_DIR}/include)
  add_test(NAME api.install
    COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/install.sh ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_C_COMPILER}
      ${CMAKE_CXX_COMPILER} ${GLSLC})
  add_test(NAME api.subproject
    COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/subproject.sh ${CMAKE_SOURCE_DIR} ${CMAKE_C_COMPILER} ${CMAKE_CXX_COMPILER}
      "${CMAKE_C_COMPILER_LAUNCHER}")
  set_tests_properties(api.exports api.install api.subproject PROPERTIES TIMEOUT 300 LABELS api)
endif()
add_test(NAME api.documented COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/documented.sh ${CMAKE_SOURCE_DIR})
set_tests_properties(api.documented PROPERTIES LABELS api)
