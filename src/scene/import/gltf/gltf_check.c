// Checks a glTF file: version, required extensions, and that the nodes form a forest.
#include "scene/import/gltf/gltf.h"

#include <stdlib.h>
#include <string.h>

// Fully supported extensions.
static const char *const KNOWN_EXTENSIONS[] = {
    "KHR_lights_punctual",   "KHR_materials_emissive_strength",
    "KHR_texture_transform", "KHR_materials_unlit",
    "KHR_materials_ior",     "KHR_materials_specular",
    "KHR_mesh_quantization", "EXT_lights_image_based",
};

// Extensions that are ignored without a note: compressed copies (a primitive without uncompressed
// data is refused when it is read) and metadata.
static const char *const HARMLESS_EXTENSIONS[] = {
    "KHR_draco_mesh_compression",
    "EXT_meshopt_compression",
    "KHR_xmp",
    "KHR_xmp_json_ld",
};

static bool is_in(const char *name, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (strcmp(name, list[i]) == 0) return true;
    }
    return false;
}

#define IS_IN(name, list) is_in((name), (list), sizeof(list) / sizeof *(list))

static bool check_version(struct gltf *gltf)
{
    struct import *import = gltf->import;
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    struct gltf_object asset = gltf_child(root, "asset");
    const char *version = gltf_string(asset, "version");
    const char *minimum = gltf_string(asset, "minVersion");
    if (gltf->failed) return false;
    if (!version) {
        return host_fail(import->host, FAIL_FORMAT, "%s: not a glTF file: it has no asset version",
                         import->path);
    }
    // 2.x files are readable by a 2.0 reader, except with a higher minVersion.
    if (strncmp(version, "2.", 2) == 0 && (!minimum || strcmp(minimum, "2.0") == 0)) return true;
    return host_fail(import->host, FAIL_UNSUPPORTED,
                     "%s: glTF version %s is not supported; only 2.0 is", import->path,
                     import_printable(minimum ? minimum : version).s);
}

static bool check_extensions(struct gltf *gltf)
{
    struct import *import = gltf->import;
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *required = gltf_array(root, "extensionsRequired");
    json_t *used = gltf_array(root, "extensionsUsed");
    const char *unsupported = NULL; // the first one
    size_t i;
    json_t *value;
    json_array_foreach(required, i, value)
    {
        const char *name = json_string_value(value);
        if (!name) return gltf_wrong(root, "extensionsRequired[%zu] is not a string", i);
        if (!unsupported && !IS_IN(name, KNOWN_EXTENSIONS)) unsupported = name;
    }
    if (unsupported) {
        return host_fail(import->host, FAIL_UNSUPPORTED,
                         "%s: requires the extension %s, which is not supported", import->path,
                         import_printable(unsupported).s);
    }
    json_array_foreach(used, i, value)
    {
        const char *name = json_string_value(value);
        if (!name) return gltf_wrong(root, "extensionsUsed[%zu] is not a string", i);
        if (IS_IN(name, KNOWN_EXTENSIONS) || IS_IN(name, HARMLESS_EXTENSIONS)) continue;
        import_note(import, "extension %s", import_printable(name).s);
    }
    return !gltf->failed;
}

bool gltf_check_asset(struct gltf *gltf)
{
    return check_version(gltf) && check_extensions(gltf);
}

// parent[child] for all nodes; UINT32_MAX for roots. A second parent is an error.
static bool find_parents(struct gltf *gltf, uint32_t *parent)
{
    size_t count = json_array_size(gltf->nodes);
    for (size_t i = 0; i < count; i++) parent[i] = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        struct gltf_object node = gltf_element(gltf, gltf->nodes, "node", i);
        size_t k;
        json_t *value;
        json_array_foreach(gltf_array(node, "children"), k, value)
        {
            int child = gltf_index_value(node, "children", value, gltf->nodes);
            if (child < 0) return false;
            if ((size_t)child == i) return gltf_wrong(node, "is its own child");
            if (parent[child] != UINT32_MAX) {
                return gltf_wrong(node, "its child %d has another parent already, node %u", child,
                                  parent[child]);
            }
            parent[child] = (uint32_t)i;
        }
    }
    return !gltf->failed;
}

// Marks the roots of the default scene, else of the first one, else all roots.
static bool mark_scene_roots(struct gltf *gltf, const uint32_t *parent)
{
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    json_t *scenes = gltf_array(root, "scenes");
    int chosen = gltf_index(root, "scene", scenes);
    if (gltf->failed) return false;
    if (json_array_size(scenes) == 0) {
        for (size_t i = 0; i < json_array_size(gltf->nodes); i++) {
            gltf->in_scene[i] = parent[i] == UINT32_MAX;
        }
        return true;
    }
    if (json_array_size(scenes) > 1) import_note(gltf->import, "scenes other than the default one");
    struct gltf_object scene = gltf_element(gltf, scenes, "scene", chosen < 0 ? 0 : (size_t)chosen);
    size_t k;
    json_t *value;
    json_array_foreach(gltf_array(scene, "nodes"), k, value)
    {
        int node = gltf_index_value(scene, "nodes", value, gltf->nodes);
        if (node < 0) return false;
        gltf->in_scene[node] = 1;
    }
    return !gltf->failed;
}

// Numbers the nodes so that parents come first: a depth-first traversal without recursion. `stack`
// has one element per node.
static uint32_t number_nodes(struct gltf *gltf, const uint32_t *parent, uint32_t *stack)
{
    size_t count = json_array_size(gltf->nodes);
    uint32_t next = 0;
    for (size_t root = 0; root < count; root++) {
        if (parent[root] != UINT32_MAX) continue;
        size_t depth = 0;
        stack[depth++] = (uint32_t)root;
        while (depth > 0) {
            uint32_t node = stack[--depth];
            gltf->scene_node[node] = next++;
            json_t *children = json_object_get(json_array_get(gltf->nodes, node), "children");
            for (size_t k = json_array_size(children); k-- > 0;) {
                json_int_t child = json_integer_value(json_array_get(children, k));
                gltf->in_scene[child] |= gltf->in_scene[node];
                stack[depth++] = (uint32_t)child;
            }
        }
    }
    return next;
}

bool gltf_order_nodes(struct gltf *gltf)
{
    struct import *import = gltf->import;
    size_t count = json_array_size(gltf->nodes);
    uint32_t *parent = host_alloc(import->host, count, sizeof *parent);
    uint32_t *stack = host_alloc(import->host, count, sizeof *stack);
    gltf->scene_node = host_alloc(import->host, count, sizeof *gltf->scene_node);
    gltf->in_scene = host_alloc(import->host, count, sizeof *gltf->in_scene);
    bool ok = parent && stack && gltf->scene_node && gltf->in_scene && find_parents(gltf, parent) &&
              mark_scene_roots(gltf, parent);
    // Each node has at most one parent, so a node that no root reaches is below a cycle.
    if (ok && number_nodes(gltf, parent, stack) < count) {
        ok = host_fail(import->host, FAIL_FORMAT,
                       "%s: the nodes form a cycle: one is its own ancestor", import->path);
    }
    host_free(import->host, parent);
    host_free(import->host, stack);
    return ok;
}
