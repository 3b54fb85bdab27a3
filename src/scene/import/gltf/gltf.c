// Imports a glTF file: the order of the steps.
#include "scene/import/gltf/gltf.h"

#include "scene/import/importers.h"

static bool load_scene(struct gltf *gltf)
{
    struct import *import = gltf->import;
    if (!gltf_check_asset(gltf) || !gltf_order_nodes(gltf) || !gltf_load_buffers(gltf))
        return false;
    gltf->cached = host_alloc(import->host, json_array_size(gltf->accessors), sizeof *gltf->cached);
    return gltf->cached && gltf_load_materials(gltf) && gltf_load_meshes(gltf) &&
           gltf_load_nodes(gltf) && gltf_load_skins(gltf) && gltf_load_animations(gltf) &&
           gltf_load_environment(gltf);
}

bool import_gltf(struct import *import, const struct file_bytes *bytes)
{
    struct gltf gltf;
    bool ok = gltf_open(&gltf, import, bytes) && load_scene(&gltf);
    gltf_close(&gltf);
    return ok;
}
