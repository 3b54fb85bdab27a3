ag_test(scene/import_scenes USES scene)
