add_library(ag_test_dnrt STATIC techniques/dnrt/sphere_fixture.c)
target_link_libraries(ag_test_dnrt PUBLIC ag_test_framework ag_techniques PRIVATE afterglow_flags m)
ag_test(techniques/dnrt/transfer USES techniques LIBRARIES ag_test_dnrt)
ag_test(techniques/dnrt/frame USES techniques LIBRARIES ag_test_dnrt ag_test_techniques ag_test_frame_fixture)
