include(${CMAKE_CURRENT_LIST_DIR}/tests_import.cmake OPTIONAL)
