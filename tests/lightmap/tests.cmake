ag_test(lightmap/lightmap USES lightmap)
ag_test(lightmap/gltf_copy USES lightmap)
