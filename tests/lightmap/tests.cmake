ag_test(lightmap/lightmap USES lightmap)
ag_test(lightmap/noise USES lightmap)
ag_test(lightmap/filter USES lightmap)
ag_test(lightmap/gltf_copy USES lightmap)
ag_test(lightmap/materials USES lightmap)
ag_test(lightmap/update USES lightmap)
ag_test(lightmap/gltf_environment USES lightmap)

# The denoiser's code, with a stand-in for Open Image Denoise.
ag_test(lightmap/denoise ALONE USES lightmap)
target_sources(test_lightmap_denoise PRIVATE ${CMAKE_SOURCE_DIR}/src/lightmap/denoise.c ${CMAKE_CURRENT_LIST_DIR}/denoiser/denoiser.c)
target_include_directories(test_lightmap_denoise PRIVATE ${CMAKE_CURRENT_LIST_DIR}/denoiser)
target_compile_definitions(test_lightmap_denoise PRIVATE AG_OPEN_IMAGE_DENOISE)
