# Scripts for other programs: examples/blender and bench/peers. Skipped without Python 3, or Blender.
add_test(NAME peers.scripts COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/scripts.sh ${CMAKE_SOURCE_DIR} $<TARGET_FILE:afterglow>)
set_tests_properties(peers.scripts PROPERTIES LABELS peers TIMEOUT 300 SKIP_RETURN_CODE 77)
add_test(NAME peers.blender COMMAND sh ${CMAKE_CURRENT_LIST_DIR}/blender.sh ${CMAKE_SOURCE_DIR} $<TARGET_FILE:afterglow>)
set_tests_properties(peers.blender PROPERTIES LABELS "peers;thorough" TIMEOUT 900 SKIP_RETURN_CODE 77)
