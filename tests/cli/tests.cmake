# The program as scripts use it.
add_library(ag_test_program STATIC ${CMAKE_CURRENT_LIST_DIR}/program.c)
target_compile_definitions(ag_test_program PRIVATE AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow>")
target_link_libraries(ag_test_program PUBLIC ag_test_framework PkgConfig::JANSSON PRIVATE afterglow_flags)
foreach(name usage info diff render)
  ag_test(cli/${name} USES image LIBRARIES ag_test_program)
  target_compile_definitions(test_cli_${name} PRIVATE AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow>")
  add_dependencies(test_cli_${name} afterglow)
endforeach()

add_test(NAME cli.examples.minimal COMMAND minimal ${CMAKE_BINARY_DIR}/tests/minimal.png)
set_tests_properties(cli.examples.minimal PROPERTIES TIMEOUT 120 LABELS cli)
