# Files that others write readers for, read by these: node with npm packages of pinned versions, which are installed into the build
# tree. Skipped where node or the packages are not there.
set(web ${CMAKE_BINARY_DIR}/tests/web)
add_test(NAME web.lightmap COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/lit.sh ${web} $<TARGET_FILE:afterglow>)
set_tests_properties(web.lightmap PROPERTIES LABELS web TIMEOUT 300 SKIP_RETURN_CODE 77 RESOURCE_LOCK web_packages)
add_test(NAME web.probes COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/probes.sh ${web} $<TARGET_FILE:afterglow> ${CMAKE_SOURCE_DIR}/docs/probes.schema.json)
set_tests_properties(web.probes PROPERTIES LABELS web TIMEOUT 300 SKIP_RETURN_CODE 77 RESOURCE_LOCK web_packages)
add_test(NAME web.page COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/page.sh ${web} $<TARGET_FILE:afterglow> ${CMAKE_SOURCE_DIR}/examples/web)
set_tests_properties(web.page PROPERTIES LABELS "web;thorough" TIMEOUT 900 SKIP_RETURN_CODE 77 RESOURCE_LOCK web_packages)
