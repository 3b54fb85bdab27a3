add_library(ag_test_vo STATIC techniques/vo/vo_fixture.c)
target_link_libraries(ag_test_vo PUBLIC ag_test_frame_fixture ag_techniques PRIVATE afterglow_flags m)
ag_test(techniques/vo/closed_forms USES techniques LIBRARIES ag_test_vo)
