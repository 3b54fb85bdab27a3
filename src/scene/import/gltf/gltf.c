// Imports a glTF file: the order of the steps.
#include "scene/import/gltf/gltf.h"

#include "scene/import/importers.h"

// {"afterglow_sky": [r, g, b]} in the extras of the default scene, cd/m²: glTF has no sky.
static bool load_sky(struct gltf *gltf)
{
    const struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *scenes = gltf_array(root, "scenes");
    const int chosen = gltf_index(root, "scene", scenes);
    if (gltf->failed || json_array_size(scenes) == 0) return !gltf->failed;
    const struct gltf_object scene =
        gltf_element(gltf, scenes, "scene", chosen < 0 ? 0 : (size_t)chosen);
    json_t *extras = json_object_get(scene.json, "extras");
    if (!json_object_get(extras, "afterglow_sky")) return !gltf->failed;
    struct gltf_object of = scene;
    of.json = extras;
    vec3s sky = gltf->import->scene->environment.sky;
    if (!gltf_floats(of, "afterglow_sky", 3, sky.raw)) return false;
    for (int c = 0; c < 3; c++)
        if (!(sky.raw[c] >= 0.0f)) return gltf_wrong(of, "afterglow_sky is negative");
    gltf->import->scene->environment.sky = sky;
    return true;
}

static bool load_scene(struct gltf *gltf)
{
    struct import *import = gltf->import;
    if (!gltf_check_asset(gltf) || !gltf_order_nodes(gltf) || !gltf_load_buffers(gltf))
        return false;
    gltf->cached = host_alloc(import->host, json_array_size(gltf->accessors), sizeof *gltf->cached);
    return gltf->cached && gltf_load_materials(gltf) && gltf_load_meshes(gltf) &&
           gltf_load_nodes(gltf) && gltf_load_skins(gltf) && gltf_load_animations(gltf) &&
           load_sky(gltf);
}

bool import_gltf(struct import *import, const struct file_bytes *bytes)
{
    struct gltf gltf;
    bool ok = gltf_open(&gltf, import, bytes) && load_scene(&gltf);
    gltf_close(&gltf);
    return ok;
}
