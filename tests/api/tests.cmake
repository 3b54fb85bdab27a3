# The public functions, through the public headers alone.
foreach(name arguments context scene catalogue reference)
  ag_test(api/${name} USES api)
endforeach()
foreach(name odd_scenes probes)
  ag_test(api/${name} USES api LIBRARIES ag_test_gpu)
endforeach()
ag_test(api/renderer USES api LIBRARIES ag_test_own_device ag_test_gpu)

# Only ag_… is to be seen from outside. (Sanitizers add names of their own.)
if(NOT AFTERGLOW_SANITIZE)
  add_test(NAME api.exports
    COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/exports.sh $<TARGET_FILE:afterglow_shared> ${CMAKE_SOURCE_DIR}/include)
  add_test(NAME api.install
    COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/install.sh ${CMAKE_BINARY_DIR} ${CMAKE_SOURCE_DIR} ${CMAKE_C_COMPILER})
  set_tests_properties(api.exports api.install PROPERTIES TIMEOUT 300 LABELS api)
endif()
add_test(NAME api.documented COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/documented.sh ${CMAKE_SOURCE_DIR})
set_tests_properties(api.documented PROPERTIES LABELS api)
