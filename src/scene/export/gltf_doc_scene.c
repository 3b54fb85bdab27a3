// A document of a scene: nodes, meshes at them, lights, cameras and skins.
#include "scene/export/gltf_scene.h"

#include <string.h>

static bool is_vec3(vec3s v, float x)
{
    return v.x == x && v.y == x && v.z == x;
}

// ---- nodes

static void add_nodes(struct scene_export *x)
{
    for (int i = 0; i < x->scene->node_count; i++)
        gltf_doc_add(x->doc, "nodes", gltf_doc_node(x->doc, &x->scene->nodes[i]));
}

static json_t *node_at(struct gltf_doc *doc, size_t node)
{
    return json_array_get(gltf_doc_array(doc, "nodes"), node);
}

static void add_hierarchy(struct scene_export *x)
{
    struct gltf_doc *doc = x->doc;
    json_t *scene = json_object();
    for (int i = 0; i < x->scene->node_count; i++) {
        const int parent = x->scene->nodes[i].parent;
        if (parent < 0)
            gltf_doc_append(doc, scene, "nodes", (size_t)i);
        else
            gltf_doc_append(doc, node_at(doc, (size_t)parent), "children", (size_t)i);
    }
    if (!is_vec3(x->scene->environment.sky, 0.0f))
        gltf_doc_set(doc, gltf_doc_child(doc, scene, "extras"), "afterglow_sky",
                     gltf_doc_floats(x->scene->environment.sky.raw, 3));
    gltf_doc_add(doc, "scenes", scene);
    gltf_doc_set(doc, doc->root, "scene", json_integer(0));
}

// ---- instances

// Instances at one node are primitives of one mesh.
static void add_instance(struct scene_export *x, int i)
{
    struct gltf_doc *doc = x->doc;
    const struct instance *instance = &x->scene->instances[i];
    const struct mesh *mesh = scene_mesh_of(x->scene, i);
    json_t *node = node_at(doc, (size_t)instance->node);
    if (!json_object_get(node, "mesh")) {
        const size_t added =
            gltf_doc_add(doc, "meshes",
                         json_pack("{s:o, s:[]}", "name",
                                   gltf_doc_text(mesh->name ? mesh->name : "mesh"), "primitives"));
        gltf_doc_set(doc, node, "mesh", json_integer((json_int_t)added));
    }
    const size_t of = (size_t)json_integer_value(json_object_get(node, "mesh"));
    json_t *primitives =
        json_object_get(json_array_get(gltf_doc_array(doc, "meshes"), of), "primitives");
    doc->places[i] = (struct gltf_place){ (size_t)instance->node, of, json_array_size(primitives) };
    json_t *primitive = gltf_doc_primitive(x, instance->mesh);
    if (json_array_append_new(primitives, json_deep_copy(primitive)) != 0) doc->failed = true;
    if (instance->skin >= 0) gltf_doc_set(doc, node, "skin", json_integer(instance->skin));
    if (instance->morph_weights)
        gltf_doc_set(doc, node, "weights",
                     gltf_doc_floats(instance->morph_weights, (size_t)mesh->morph_count));
    gltf_doc_mobility(doc, node, instance);
}

static void add_instances(struct scene_export *x)
{
    for (int i = 0; i < x->scene->instance_count; i++) {
        x->doc->places[i].node = SIZE_MAX;
        if (x->scene->instances[i].mesh >= 0) add_instance(x, i);
    }
}

// ---- lights and cameras

static const char LIGHTS[] = "KHR_lights_punctual";

// glTF has one light or camera of a node: others have nodes of their own.
static json_t *free_node(struct gltf_doc *doc, int node, const char *key, const char *extension)
{
    json_t *at = node_at(doc, (size_t)node);
    json_t *taken = json_object_get(at, key);
    if (taken && extension) taken = json_object_get(taken, extension);
    if (!taken) return at;
    const size_t added = gltf_doc_add(doc, "nodes", json_object());
    gltf_doc_append(doc, at, "children", added);
    return node_at(doc, added);
}

static void add_lights(struct scene_export *x)
{
    for (int i = 0; i < x->scene->light_count; i++) {
        const struct light *light = &x->scene->lights[i];
        if (!light->off)
            gltf_doc_light(x->doc, free_node(x->doc, light->node, "extensions", LIGHTS), light);
    }
}

static void add_cameras(struct scene_export *x)
{
    struct gltf_doc *doc = x->doc;
    for (int i = 0; i < x->scene->camera_count; i++) {
        const struct camera *camera = &x->scene->cameras[i];
        const size_t added = gltf_doc_add(
            doc, "cameras",
            json_pack("{s:o, s:s, s:{s:f, s:f}}", "name",
                      gltf_doc_text(camera->name ? camera->name : "camera"), "type", "perspective",
                      "perspective", "yfov", (double)camera->vertical_fov_rad, "znear",
                      (double)camera->near_m));
        gltf_doc_set(doc, free_node(doc, camera->node, "camera", NULL), "camera",
                     json_integer((json_int_t)added));
    }
}

// ---- skins

static void add_skins(struct scene_export *x)
{
    struct gltf_doc *doc = x->doc;
    for (int i = 0; i < x->scene->skin_count; i++) {
        const struct skin *skin = &x->scene->skins[i];
        const size_t matrices = gltf_doc_add_accessor(doc, skin->joint_from_mesh, GLTF_FLOAT,
                                                      "MAT4", (size_t)skin->joint_count);
        json_t *out =
            json_pack("{s:[], s:I}", "joints", "inverseBindMatrices", (json_int_t)matrices);
        for (int k = 0; out && k < skin->joint_count; k++)
            gltf_doc_append(doc, out, "joints", (size_t)skin->joints[k]);
        gltf_doc_add(doc, "skins", out);
    }
}

bool gltf_doc_of_scene(struct gltf_doc *doc, struct host *host, const struct scene *scene)
{
    if (!gltf_doc_init(doc, host)) return false;
    struct scene_export x = { .doc = doc, .scene = scene };
    doc->places = host_alloc(host, (size_t)scene->instance_count, sizeof *doc->places);
    x.primitives = host_alloc(host, (size_t)scene->mesh_count, sizeof(json_t *));
    const bool ok = doc->places && x.primitives;
    if (ok) {
        doc->place_count = scene->instance_count;
        gltf_doc_set(doc, doc->root, "asset",
                     json_pack("{s:s, s:s}", "version", "2.0", "generator", "Afterglow"));
        gltf_doc_materials(&x);
        add_nodes(&x);
        add_hierarchy(&x);
        add_instances(&x);
        add_lights(&x);
        gltf_doc_environment(doc, json_array_get(gltf_doc_array(doc, "scenes"), 0),
                             &scene->environment);
        add_cameras(&x);
        add_skins(&x);
        gltf_doc_animations(&x);
    }
    gltf_doc_finish_primitives(&x);
    return ok &&
           (!doc->failed || host_fail(host, FAIL_MEMORY, "%s: glTF: out of memory", scene->name));
}
