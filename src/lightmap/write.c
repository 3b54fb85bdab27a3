// The files of a light map: the scene's copy, and a map for each side.
#include "lightmap/write.h"

#include "image/exr.h"
#include "lightmap/attach.h"

#include <stdio.h>

static const char *const files[LIGHTMAP_SIDES] = { LIGHTMAP_FRONT_FILE, LIGHTMAP_BACK_FILE };
static const char *const sides[LIGHTMAP_SIDES] = { "front", "back" };

static const char *light_text(const struct lightmap_facts *facts)
{
    return facts->punctual ? "direct and indirect"
                           : "indirect, and direct of emissive surfaces and the sky";
}

// ---- the scene's copy

// A light that the bake had has its indirect light in the map, and with `punctual` its direct
// light.
static void mark_lights(struct gltf_doc *doc, const struct lightmap_facts *facts)
{
    json_t *extension =
        json_object_get(json_object_get(doc->root, "extensions"), "KHR_lights_punctual");
    size_t i;
    json_t *light;
    json_array_foreach(json_object_get(extension, "lights"), i, light)
    {
        const bool on = i >= doc->off_light_count || !doc->off_lights[i];
        gltf_doc_set(doc, gltf_doc_child(doc, light, "extras"), LIGHTMAP_EXTRAS,
                     json_pack("{s:b, s:b}", "direct", on && facts->punctual, "indirect", on));
    }
}

static json_t *map_json(const struct lightmap *map, int side)
{
    const struct image *image = &map->irradiance[side];
    return json_pack("{s:s, s:s, s:i, s:i}", "uri", files[side], "side", sides[side], "width",
                     image->width, "height", image->height);
}

static void describe(struct gltf_doc *doc, const struct lightmap *map,
                     const struct lightmap_facts *facts)
{
    json_t *maps = json_array();
    for (int side = 0; side < (map->has_back ? 2 : 1); side++)
        if (json_array_append_new(maps, map_json(map, side)) != 0) doc->failed = true;
    json_t *out =
        json_pack("{s:s, s:s, s:s, s:o, s:o}", "quantity", "irradiance", "unit", "lx", "light",
                  light_text(facts), "gi", gltf_doc_text(facts->gi), "maps", maps);
    if (facts->samples > 0)
        gltf_doc_set(doc, out, "samples", json_integer((json_int_t)facts->samples));
    gltf_doc_set(doc, gltf_doc_child(doc, doc->root, "extras"), LIGHTMAP_EXTRAS, out);
}

static bool write_scene(const struct lightmap *map, const struct scene *scene,
                        const struct lightmap_facts *facts, const char *path)
{
    struct gltf_doc doc = { 0 };
    bool same;
    bool ok = gltf_doc_of_file(&doc, map->host, scene, &same) &&
              (same || gltf_doc_of_scene(&doc, map->host, scene)) &&
              lightmap_attach(&doc, &map->charts, scene);
    if (ok) mark_lights(&doc, facts);
    if (ok) describe(&doc, map, facts);
    ok = ok && gltf_doc_write(&doc, path);
    gltf_doc_finish(&doc);
    return ok;
}

// ---- maps

static bool write_map(const struct lightmap *map, int side, const struct lightmap_facts *facts,
                      const char *path)
{
    char samples[16];
    snprintf(samples, sizeof samples, "%d", facts->samples);
    const struct exr_layer layer = { "color", &map->irradiance[side] };
    const struct exr_attribute attributes[] = {
        { "afterglow.quantity", "irradiance" },
        { "afterglow.unit", "lx" },
        { "afterglow.light", light_text(facts) },
        { "afterglow.side", sides[side] },
        { "afterglow.gi", facts->gi },
        { "afterglow.samples", samples },
    };
    return exr_write(map->host, path, &layer, 1, attributes,
                     facts->samples > 0 ? (int)(sizeof attributes / sizeof *attributes)
                                        : (int)(sizeof attributes / sizeof *attributes) - 1);
}

bool lightmap_write(const struct lightmap *map, const struct scene *scene,
                    const struct lightmap_facts *facts, const char *folder)
{
    bool ok = true;
    for (int side = 0; ok && side < (map->has_back ? 2 : 1); side++) {
        char *path = host_sprintf(map->host, "%s/%s", folder, files[side]);
        ok = path && write_map(map, side, facts, path);
        host_free(map->host, path);
    }
    char *path = ok ? host_sprintf(map->host, "%s/%s", folder, LIGHTMAP_SCENE_FILE) : NULL;
    ok = path && write_scene(map, scene, facts, path);
    host_free(map->host, path);
    return ok;
}
