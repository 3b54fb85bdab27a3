# The program as scripts use it.
add_library(ag_test_program STATIC ${CMAKE_CURRENT_LIST_DIR}/program.c ${CMAKE_CURRENT_LIST_DIR}/screen.c)
target_compile_definitions(ag_test_program PRIVATE AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow>")
target_link_libraries(ag_test_program PUBLIC ag_test_framework PkgConfig::JANSSON PRIVATE afterglow_flags)
foreach(name usage info environment diff reference render interrupt hostile lightmap lightmap_lights lightmap_pages lightmap_report probes export unwrap scale complete tonemap)
  ag_test(cli/${name} USES image LIBRARIES ag_test_program)
endforeach()
foreach(name folders references report)
  ag_test(cli/compare/${name} USES image LIBRARIES ag_test_program)
endforeach()
target_sources(test_cli_compare PRIVATE ${CMAKE_CURRENT_LIST_DIR}/compare/compare_run.c)
foreach(program test_cli test_cli_compare)
  target_compile_definitions(${program} PRIVATE AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow>")
  add_dependencies(${program} afterglow)
endforeach()
if(AFTERGLOW_VIEWER)
  foreach(name blocks edits inspect methods paint random scene scripts window)
    ag_test(cli/view/${name} USES image api LIBRARIES ag_test_program TIMEOUT 600)
  endforeach()
  foreach(fixture cheap_bakes view_random view_run window)
    target_sources(test_cli_view PRIVATE ${CMAKE_CURRENT_LIST_DIR}/view/${fixture}.c)
  endforeach()
  target_compile_definitions(test_cli_view PRIVATE AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow>"
    IMAGE_LIGHT="${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/gltf/image_light.gltf")
  add_dependencies(test_cli_view afterglow)
endif()

# The program with a technique that bakes in no time.
add_executable(afterglow_sample ${CMAKE_SOURCE_DIR}/app/cli/main.c $<TARGET_OBJECTS:ag_test_sample_registry>)
target_link_libraries(afterglow_sample PRIVATE afterglow_commands afterglow_flags)
set_target_properties(afterglow_sample PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
add_library(ag_test_sample_program STATIC ${CMAKE_CURRENT_LIST_DIR}/program.c)
target_compile_definitions(ag_test_sample_program PUBLIC AFTERGLOW_PROGRAM="$<TARGET_FILE:afterglow_sample>")
target_link_libraries(ag_test_sample_program PUBLIC ag_test_framework PkgConfig::JANSSON PRIVATE afterglow_flags)
ag_test(cli/bake ALONE LIBRARIES ag_test_sample_program)
add_library(ag_test_full_disk MODULE ${CMAKE_CURRENT_LIST_DIR}/full_disk.c)
target_compile_definitions(test_cli_bake PRIVATE FULL_DISK="$<TARGET_FILE:ag_test_full_disk>")
add_dependencies(test_cli_bake ag_test_full_disk)
add_dependencies(test_cli_bake afterglow_sample)

# The page of compare, written by the program's own code and used in a browser, where there is one.
add_library(ag_test_report STATIC ${CMAKE_CURRENT_LIST_DIR}/report_sample.c ${CMAKE_CURRENT_LIST_DIR}/browser.c)
target_link_libraries(ag_test_report PUBLIC ag_test_program ag_image afterglow_commands PRIVATE afterglow_flags)
ag_test(cli/report_page LIBRARIES ag_test_report)
ag_test(cli/waiting LIBRARIES ag_test_report)
ag_test(cli/terminal LIBRARIES ag_test_report)
ag_test(cli/report_page_browser LIBRARIES ag_test_report)
ag_test(cli/lightmap_page LIBRARIES ag_test_report)
set_tests_properties(cli.report_page_browser cli.lightmap_page PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: no Chromium")

# The manual page, against what the program prints, and completion in each shell.
add_test(NAME cli.manual COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/manual.sh ${CMAKE_BINARY_DIR}/manual $<TARGET_FILE:afterglow>)
set_tests_properties(cli.manual PROPERTIES TIMEOUT 60 LABELS cli)
foreach(shell bash zsh fish)
  add_test(NAME cli.complete_${shell} COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/completions.sh
    ${shell} ${CMAKE_SOURCE_DIR}/app/completions $<TARGET_FILE:afterglow>)
  set_tests_properties(cli.complete_${shell} PROPERTIES TIMEOUT 300 LABELS cli SKIP_RETURN_CODE 77)
endforeach()

# The examples, as their readers would run them.
set(images ${CMAKE_BINARY_DIR}/tests)
add_test(NAME examples.minimal COMMAND minimal ${images}/minimal.png)
add_test(NAME examples.textured COMMAND textured ${images}/textured.png)
add_test(NAME examples.measure COMMAND measure @cornell:light=point ${images}/measure.exr none lpv vct radiosity:texels=4096,rays=64 mrt:texels=8,rays=256,prior_modes=16)
add_test(NAME examples.side_by_side COMMAND side_by_side @cornell:light=point none ambient 64 48 ${images}/pair.png)
add_test(NAME examples.balls COMMAND balls @cornell:light=point lpv:probes=true,dim=16 64 48 ${images}/balls.png)
add_test(NAME examples.views COMMAND views @cornell:light=point lpv:dim=16 64 48 ${images}/views.png)
add_test(NAME examples.host COMMAND host ${images}/host.png validate)
add_test(NAME examples.engine COMMAND engine ${images}/engine_reversed.png ${images}/engine_forward.png validate)
add_test(NAME examples.embed_1 COMMAND embed_1)
foreach(step 2 3)
  add_test(NAME examples.embed_${step} COMMAND embed_${step} ${images}/embed_${step}.png validate)
endforeach()
add_test(NAME examples.embed_page
  COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/quoted.sh ${CMAKE_SOURCE_DIR}/docs/embed.md ${CMAKE_SOURCE_DIR}/examples)
set_tests_properties(examples.minimal examples.textured examples.measure examples.side_by_side examples.balls examples.views examples.host examples.engine
  examples.embed_1 examples.embed_2 examples.embed_3 examples.embed_page PROPERTIES TIMEOUT 300 LABELS examples)
add_test(NAME bench.frame
  COMMAND bench_frame --frames 2 --size 48x27 --gi none --gi lpv --csv ${images}/frame.csv @cornell:light=point)
set_tests_properties(bench.frame PROPERTIES TIMEOUT 300 LABELS examples PASS_REGULAR_EXPRESSION "lpv.propagate +- +- +[0-9.]+ ")

# Drivers leave memory behind when they are unloaded, without a name by which to suppress it. What of ours lives on a device
# is held to account by the tests of gpu, frame and api.
set_tests_properties(cli.bake cli.environment cli.info cli.interrupt cli.render cli.compare.folders cli.compare.references cli.compare.report examples.minimal examples.textured examples.measure examples.side_by_side examples.balls examples.views examples.host examples.engine
  examples.embed_1 examples.embed_2 examples.embed_3 bench.frame
  PROPERTIES ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
if(AFTERGLOW_VIEWER)
  set_tests_properties(cli.view.methods cli.view.random cli.view.scripts cli.view.window PROPERTIES ENVIRONMENT ASAN_OPTIONS=detect_leaks=0)
endif()
