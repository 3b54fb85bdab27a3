// Additions of a scene to its file: lights, instances, the sky, the environment. Lights of the file
// that the scene has no more, or has switched off, stay as they are and are listed in
// doc->off_lights.
#include "scene/export/gltf_scene.h"

#include "scene/import/gltf/gltf.h"

static const char LIGHTS[] = "KHR_lights_punctual";

struct added {
    struct gltf_doc *doc;
    struct gltf *gltf;
    const struct scene *scene;
    int file_nodes; // nodes of the scene from this one on are in no file
};

// ---- the default scene

static void append_roots(const struct added *a, json_t *out)
{
    for (size_t i = 0; i < (size_t)a->file_nodes; i++)
        if (a->scene->nodes[a->gltf->scene_node[i]].parent < 0)
            gltf_doc_append(a->doc, out, "nodes", i);
}

// A file without scenes shows all its nodes: it gets a scene of their roots.
static json_t *default_scene(const struct added *a)
{
    json_t *scenes = gltf_doc_array(a->doc, "scenes");
    if (json_array_size(scenes) == 0) {
        json_t *made = json_object();
        append_roots(a, made);
        gltf_doc_add(a->doc, "scenes", made);
        gltf_doc_set(a->doc, a->doc->root, "scene", json_integer(0));
    }
    const json_int_t chosen = json_integer_value(json_object_get(a->doc->root, "scene"));
    return json_array_get(scenes, (size_t)chosen);
}

// Returns the node, and its index in the document.
static json_t *add_node(const struct added *a, int node, size_t *index)
{
    json_t *scene = default_scene(a), *out = gltf_doc_node(a->doc, &a->scene->nodes[node]);
    *index = gltf_doc_add(a->doc, "nodes", out);
    gltf_doc_append(a->doc, scene, "nodes", *index);
    return out;
}

// ---- the sky

static bool has_sky(json_t *sky, vec3s radiance)
{
    for (size_t c = 0; c < 3; c++)
        if ((float)json_number_value(json_array_get(sky, c)) != radiance.raw[c]) return false;
    return true;
}

static void add_sky(const struct added *a)
{
    static const char SKY[] = "afterglow_sky";
    const vec3s sky = a->scene->environment.sky;
    json_t *scenes = json_object_get(a->doc->root, "scenes");
    json_t *given = NULL;
    if (json_array_size(scenes) > 0)
        given = json_object_get(json_object_get(default_scene(a), "extras"), SKY);
    if (has_sky(given, sky)) return;
    gltf_doc_set(a->doc, gltf_doc_child(a->doc, default_scene(a), "extras"), SKY,
                 gltf_doc_floats(sky.raw, 3));
}

// ---- the environment

// A file that has the scene's environment is not changed.
static void add_environment(const struct added *a)
{
    const struct environment *environment = &a->scene->environment;
    if (environment_map_use_key(environment) == a->scene->file_environment) return;
    json_t *scene = default_scene(a);
    gltf_doc_remove_environment(a->doc, scene);
    gltf_doc_environment(a->doc, scene, environment);
}

// ---- lights

static bool is_of_file(const struct added *a, const struct light *light)
{
    return light->node < a->file_nodes;
}

// The light of a node in the file, by its index there; -1: none, or the sun of an environment.
static int light_at(const struct added *a, size_t node)
{
    const int light =
        gltf_index(gltf_extension(gltf_element(a->gltf, a->gltf->nodes, "node", node), LIGHTS),
                   "light", a->gltf->lights);
    const json_t *json = light < 0 ? NULL : json_array_get(a->gltf->lights, (size_t)light);
    return gltf_is_environment_sun(json) ? -1 : light;
}

// Nodes with the same light, not all of which emit: those that do not get a copy of it.
static void separate_light(const struct added *a, size_t node, int light)
{
    json_t *list = a->gltf->lights;
    const size_t copy = json_array_size(list);
    json_t *extensions = json_object_get(json_array_get(a->gltf->nodes, node), "extensions");
    if (json_array_append_new(list, json_deep_copy(json_array_get(list, (size_t)light))) != 0)
        a->doc->failed = true;
    gltf_doc_set(a->doc, json_object_get(extensions, LIGHTS), "light",
                 json_integer((json_int_t)copy));
    a->doc->off_lights[copy] = true;
}

static void find_off_lights(const struct added *a, bool *emits)
{
    bool *off = a->doc->off_lights;
    for (int i = 0; i < a->scene->light_count; i++) {
        const struct light *light = &a->scene->lights[i];
        if (is_of_file(a, light) && !light->off) emits[light->node] = true;
    }
    for (size_t i = 0; i < json_array_size(a->gltf->lights); i++)
        off[i] = !gltf_is_environment_sun(json_array_get(a->gltf->lights, i));
    for (size_t i = 0; i < (size_t)a->file_nodes; i++) {
        const int light = light_at(a, i);
        if (light >= 0 && emits[a->gltf->scene_node[i]]) off[light] = false;
    }
    for (size_t i = 0; i < (size_t)a->file_nodes; i++) {
        const int light = light_at(a, i);
        const bool emitter = emits[a->gltf->scene_node[i]];
        if (light >= 0 && a->gltf->in_scene[i] && !emitter && !off[light])
            separate_light(a, i, light);
    }
}

static bool add_lights(const struct added *a)
{
    struct host *host = a->doc->host;
    const size_t nodes = (size_t)a->file_nodes, lights = json_array_size(a->gltf->lights);
    bool *emits = host_alloc(host, nodes, sizeof *emits);
    a->doc->off_lights = host_alloc(host, lights + nodes, sizeof *a->doc->off_lights);
    const bool ok = emits && a->doc->off_lights;
    if (ok) find_off_lights(a, emits);
    a->doc->off_light_count = json_array_size(a->gltf->lights);
    for (int i = 0; ok && i < a->scene->light_count; i++) {
        const struct light *light = &a->scene->lights[i];
        size_t node;
        if (!is_of_file(a, light) && !light->off)
            gltf_doc_light(a->doc, add_node(a, light->node, &node), light);
    }
    host_free(host, emits);
    return ok && !a->gltf->failed;
}

// ---- instances

static void add_instance(const struct added *a, struct scene_export *x, int i)
{
    struct gltf_doc *doc = a->doc;
    const struct instance *instance = &a->scene->instances[i];
    const struct mesh *mesh = scene_mesh_of(a->scene, i);
    size_t node;
    json_t *at = add_node(a, instance->node, &node);
    const size_t material = gltf_doc_add(
        doc, "materials", gltf_doc_material(doc, &a->scene->materials[mesh->material]));
    json_t *primitive = json_deep_copy(gltf_doc_primitive(x, instance->mesh));
    gltf_doc_set(doc, primitive, "material", json_integer((json_int_t)material));
    const size_t added = gltf_doc_add(doc, "meshes",
                                      json_pack("{s:o, s:[o]}", "name",
                                                gltf_doc_text(mesh->name ? mesh->name : "mesh"),
                                                "primitives", primitive));
    gltf_doc_set(doc, at, "mesh", json_integer((json_int_t)added));
    gltf_doc_mobility(doc, at, instance);
    doc->places[i] = (struct gltf_place){ node, added, 0 };
}

static bool add_instances(const struct added *a)
{
    struct host *host = a->doc->host;
    const int count = a->scene->instance_count, first = a->doc->place_count;
    struct scene_export x = { .doc = a->doc, .scene = a->scene };
    if (first == count) return true;
    x.primitives = host_alloc(host, (size_t)a->scene->mesh_count, sizeof *x.primitives);
    for (int i = first; x.primitives && i < count; i++) {
        a->doc->places[i].node = SIZE_MAX;
        if (a->scene->instances[i].mesh >= 0) add_instance(a, &x, i);
    }
    a->doc->place_count = count;
    const bool ok = x.primitives;
    gltf_doc_finish_primitives(&x);
    return ok;
}

// ---- objects that can be added

static bool has_maps(const struct material *m)
{
    return m->base_color_map.image >= 0 || m->metallic_roughness_map.image >= 0 ||
           m->normal_map.image >= 0 || m->emissive_map.image >= 0 || m->specular_map.image >= 0 ||
           m->specular_color_map.image >= 0;
}

// Images of the scene have other indices than those of the file.
static bool can_add(const struct scene *scene, int instance, int file_nodes)
{
    const struct instance *it = &scene->instances[instance];
    const struct mesh *mesh = scene_mesh_of(scene, instance);
    return it->mesh < 0 || (it->skin < 0 && !it->morph_weights && it->node >= file_nodes &&
                            !has_maps(&scene->materials[mesh->material]));
}

bool gltf_doc_can_add(const struct gltf_doc *doc, const struct scene *scene, size_t file_nodes)
{
    for (int i = 0; i < scene->instance_count; i++) {
        const struct instance *it = &scene->instances[i];
        if (i < doc->place_count ? it->mesh < 0 || it->added > 0
                                 : !can_add(scene, i, (int)file_nodes))
            return false;
    }
    return true;
}

bool gltf_doc_add_rest(struct gltf_doc *doc, struct gltf *gltf, const struct scene *scene)
{
    const struct added a = {
        .doc = doc, .gltf = gltf, .scene = scene, .file_nodes = (int)json_array_size(gltf->nodes)
    };
    if (!add_lights(&a) || !add_instances(&a)) return false;
    add_sky(&a);
    add_environment(&a);
    return true;
}
