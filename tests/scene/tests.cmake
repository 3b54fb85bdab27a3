include(${CMAKE_CURRENT_LIST_DIR}/tests_import.cmake OPTIONAL)
ag_test(scene/scene USES scene)
ag_test(scene/pose USES scene)
ag_test(scene/builtin USES scene)
