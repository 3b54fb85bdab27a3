// The environment of a scene: floats as OpenEXR in the buffer, named in the extras of the scene,
// which other readers ignore. Its sun is a light too, which they read.
#include "scene/export/gltf_scene.h"

#include "image/exr.h"
#include "scene/environment/environment_map.h"
#include "scene/import/gltf/gltf.h"
#include "scene/pose.h"
#include "scene/scene_check.h"

static const char LIGHTS[] = "KHR_lights_punctual";

static void set_extras(struct gltf_doc *doc, json_t *scene, const struct environment *environment,
                       size_t view)
{
    const struct environment_map *map = environment->map;
    json_t *out = json_pack("{s:I, s:f, s:f, s:o}", "bufferView", (json_int_t)view, "strength",
                            (double)environment->strength, "rotation",
                            (double)environment->rotation_rad, "name", gltf_doc_text(map->name));
    if (map->sun.found)
        gltf_doc_set(doc, out, "sun",
                     json_pack("{s:o, s:o, s:f}", "direction",
                               gltf_doc_floats(map->sun.to_sun.raw, 3), "illuminance",
                               gltf_doc_floats(map->sun.illuminance_lux.raw, 3), "radius",
                               (double)map->sun.radius_rad));
    gltf_doc_set(doc, gltf_doc_child(doc, scene, "extras"), GLTF_ENVIRONMENT, out);
}

static json_t *last_light(struct gltf_doc *doc)
{
    json_t *extension = json_object_get(json_object_get(doc->root, "extensions"), LIGHTS);
    json_t *lights = json_object_get(extension, "lights");
    return json_array_get(lights, json_array_size(lights) - 1);
}

static void add_sun(struct gltf_doc *doc, json_t *scene, const struct environment *environment)
{
    struct world_light sun;
    struct node node = node_default();
    if (!environment_sun_light(environment, &sun)) return;
    const struct light light = { .name = "sun of the environment",
                                 .type = LIGHT_SUN,
                                 .intensity = sun.intensity };
    node.name = light.name;
    node.has_matrix = scene_looking(vec3_of(0, 0, 0), sun.direction, &node.matrix);
    json_t *json = gltf_doc_node(doc, &node);
    gltf_doc_append(doc, scene, "nodes", gltf_doc_add(doc, "nodes", json));
    gltf_doc_light(doc, json, &light);
    gltf_doc_set(doc, gltf_doc_child(doc, last_light(doc), "extras"), GLTF_ENVIRONMENT_SUN,
                 json_true());
}

void gltf_doc_environment(struct gltf_doc *doc, json_t *scene,
                          const struct environment *environment)
{
    uint8_t *bytes = NULL;
    size_t size = 0;
    if (!environment->map) return;
    if (exr_encode(doc->host, &environment->map->radiance, &bytes, &size)) {
        set_extras(doc, scene, environment, gltf_doc_add_view(doc, bytes, size));
        add_sun(doc, scene, environment);
    } else {
        doc->failed = true;
    }
    host_free(doc->host, bytes);
}

static void remove_suns(struct gltf_doc *doc)
{
    json_t *lights = json_object_get(
        json_object_get(json_object_get(doc->root, "extensions"), LIGHTS), "lights");
    size_t i;
    json_t *node;
    json_array_foreach(json_object_get(doc->root, "nodes"), i, node)
    {
        json_t *extensions = json_object_get(node, "extensions");
        const json_t *light = json_object_get(json_object_get(extensions, LIGHTS), "light");
        if (light &&
            gltf_is_environment_sun(json_array_get(lights, (size_t)json_integer_value(light))))
            json_object_del(extensions, LIGHTS);
    }
}

void gltf_doc_remove_environment(struct gltf_doc *doc, json_t *scene)
{
    json_object_del(json_object_get(scene, "extensions"), "EXT_lights_image_based");
    json_object_del(json_object_get(scene, "extras"), GLTF_ENVIRONMENT);
    remove_suns(doc);
}
