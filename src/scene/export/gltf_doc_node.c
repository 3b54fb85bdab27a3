// Nodes of a document, and lights at them.
#include "scene/export/gltf_scene.h"

#include <math.h>

static const char LIGHTS[] = "KHR_lights_punctual";

static bool is_vec3(vec3s v, float x)
{
    return v.x == x && v.y == x && v.z == x;
}

static void add_transform(struct gltf_doc *doc, json_t *out, const struct node *node)
{
    if (node->has_matrix) {
        gltf_doc_set(doc, out, "matrix", gltf_doc_floats(&node->matrix.raw[0][0], 16));
        return;
    }
    if (!is_vec3(node->translation, 0.0f))
        gltf_doc_set(doc, out, "translation", gltf_doc_floats(node->translation.raw, 3));
    if (node->rotation.x != 0.0f || node->rotation.y != 0.0f || node->rotation.z != 0.0f)
        gltf_doc_set(doc, out, "rotation", gltf_doc_floats(node->rotation.raw, 4));
    if (!is_vec3(node->scale, 1.0f))
        gltf_doc_set(doc, out, "scale", gltf_doc_floats(node->scale.raw, 3));
}

json_t *gltf_doc_node(struct gltf_doc *doc, const struct node *node)
{
    json_t *out = json_object();
    if (node->name) gltf_doc_set(doc, out, "name", gltf_doc_text(node->name));
    add_transform(doc, out, node);
    if (node->extras) gltf_doc_set(doc, out, "extras", json_loads(node->extras, 0, NULL));
    return out;
}

void gltf_doc_append(struct gltf_doc *doc, json_t *object, const char *key, size_t value)
{
    json_t *list = json_object_get(object, key);
    if (!list) {
        gltf_doc_set(doc, object, key, json_array());
        list = json_object_get(object, key);
    }
    if (json_array_append_new(list, json_integer((json_int_t)value)) != 0) doc->failed = true;
}

void gltf_doc_mobility(struct gltf_doc *doc, json_t *node, const struct instance *instance)
{
    if (instance->movable)
        gltf_doc_set(doc, gltf_doc_child(doc, node, "extras"), "afterglow_mobility",
                     json_string("movable"));
}

// ---- lights

// A power of two that is at least the largest component: products with it are exact.
static float strength_of(vec3s v)
{
    int exponent;
    const float most = glms_vec3_max(v);
    if (!(most > 1.0f)) return 1.0f;
    frexpf(most, &exponent);
    return ldexpf(1.0f, exponent);
}

static json_t *light_json(const struct light *light)
{
    static const char *const types[] = { "directional", "point", "spot" };
    const float strength = strength_of(light->intensity);
    const vec3s color = glms_vec3_divs(light->intensity, strength);
    json_t *out = json_pack(
        "{s:o, s:s, s:o, s:f}", "name", gltf_doc_text(light->name ? light->name : "light"), "type",
        types[light->type], "color", gltf_doc_floats(color.raw, 3), "intensity", (double)strength);
    if (out && light->range_m > 0.0f)
        json_object_set_new(out, "range", json_real((double)light->range_m));
    if (out && light->type == LIGHT_SPOT)
        json_object_set_new(out, "spot",
                            json_pack("{s:f, s:f}", "innerConeAngle", (double)light->inner_rad,
                                      "outerConeAngle", (double)light->outer_rad));
    return out;
}

void gltf_doc_light(struct gltf_doc *doc, json_t *node, const struct light *light)
{
    gltf_doc_use_extension(doc, LIGHTS);
    json_t *root = gltf_doc_child(doc, gltf_doc_child(doc, doc->root, "extensions"), LIGHTS);
    if (!json_object_get(root, "lights")) gltf_doc_set(doc, root, "lights", json_array());
    json_t *list = json_object_get(root, "lights");
    if (json_array_append_new(list, light_json(light)) != 0) doc->failed = true;
    gltf_doc_set(doc, gltf_doc_child(doc, gltf_doc_child(doc, node, "extensions"), LIGHTS), "light",
                 json_integer((json_int_t)json_array_size(list) - 1));
}
