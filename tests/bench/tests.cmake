# Parts of the benchmarks, and a small run of some of them.
ag_test(bench/plot USES core)
target_sources(test_bench_plot PRIVATE ${CMAKE_SOURCE_DIR}/bench/plot.c)
target_include_directories(test_bench_plot PRIVATE ${CMAKE_SOURCE_DIR})

add_test(NAME bench.paper_lpv COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/paper_lpv.sh $<TARGET_FILE:bench_paper_lpv> $<TARGET_FILE:afterglow>)
set_tests_properties(bench.paper_lpv PROPERTIES TIMEOUT 300 LABELS bench SKIP_RETURN_CODE 77)
add_test(NAME bench.paper_mrt COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/paper_mrt.sh $<TARGET_FILE:bench_paper_mrt> $<TARGET_FILE:afterglow>)
set_tests_properties(bench.paper_mrt PROPERTIES TIMEOUT 300 LABELS bench SKIP_RETURN_CODE 77)
add_test(NAME bench.paper_vct COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/paper_vct.sh $<TARGET_FILE:bench_paper_vct> $<TARGET_FILE:afterglow>)
set_tests_properties(bench.paper_vct PROPERTIES TIMEOUT 300 LABELS bench SKIP_RETURN_CODE 77)
add_test(NAME bench.occlusion COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/occlusion.sh $<TARGET_FILE:bench_occlusion> $<TARGET_FILE:afterglow>)
set_tests_properties(bench.occlusion PROPERTIES TIMEOUT 300 LABELS bench SKIP_RETURN_CODE 77)
