add_library(ag_test_lpv STATIC techniques/lpv/geometry_fixture.c techniques/lpv/geometry_twin.c techniques/lpv/lpv_fixture.c
  techniques/lpv/lpv_twin.c techniques/lpv/lpv_twin_closed.c techniques/lpv/lpv_twin_product.c techniques/lpv/mesh_fixture.c
  techniques/lpv/rsm_fixture.c)
target_link_libraries(ag_test_lpv PUBLIC ag_test_frame_fixture ag_test_techniques ag_techniques PRIVATE afterglow_flags m)
foreach(name bounce cascades flux geometry_maps geometry_scene history math occlusion sky twin)
  ag_test(techniques/lpv/${name} USES techniques LIBRARIES ag_test_lpv)
endforeach()
ag_technique_tests(lpv/specular)
