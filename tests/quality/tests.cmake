# Techniques against the path-traced reference: one test for each .case file. References are cached between runs.
add_executable(test_quality_case ${CMAKE_CURRENT_LIST_DIR}/test_case.c)
target_link_libraries(test_quality_case PRIVATE ag_test_program afterglow_flags)
set_target_properties(test_quality_case PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_dependencies(test_quality_case afterglow)
file(GLOB cases CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/*.case)
foreach(case ${cases})
  get_filename_component(name ${case} NAME_WE)
  add_test(NAME quality.${name} COMMAND test_quality_case)
  set_tests_properties(quality.${name} PROPERTIES TIMEOUT 300 LABELS quality
    ENVIRONMENT "AFTERGLOW_QUALITY_CASE=${case};AFTERGLOW_VALIDATION=1;AFTERGLOW_CACHE=${CMAKE_BINARY_DIR}/quality-cache;ASAN_OPTIONS=detect_leaks=0")
endforeach()
