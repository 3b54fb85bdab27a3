add_library(ag_test_ort STATIC techniques/ort/map_fixture.c)
target_link_libraries(ag_test_ort PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
ag_test(techniques/ort/bins USES techniques LIBRARIES ag_test_ort)
