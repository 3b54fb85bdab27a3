ag_test(scene/import_scenes USES scene)
ag_test(scene/import_cut USES scene)
ag_test(scene/import_assimp USES scene)
