// The files of a light map: the scene's copy, and a map for each side and format.
#include "lightmap/write.h"

#include "core/files/file.h"
#include "core/text.h"
#include "image/exr.h"
#include "image/ktx2.h"
#include "lightmap/attach.h"
#include "lightmap/materials.h"
#include "lightmap/update/record.h"
#include "lightmap/texture.h"

#include <stdio.h>
#include <string.h>

static const char *const names[LIGHTMAP_SIDES] = { LIGHTMAP_FRONT_FILE, LIGHTMAP_BACK_FILE };
static const char *const sides[LIGHTMAP_SIDES] = { "front", "back" };
enum { FORMATS = 3, MAX_FACTS = 6 };
static const char *const endings[FORMATS] = { "exr", "ktx2", "png" }; // in the order of the bits

struct side {
    const struct image *image;
    float scale[FORMATS]; // lux of the value 1
    uint8_t *png;
    size_t png_size;
};

struct writing {
    const struct lightmap *map;
    const struct scene *scene;
    const struct lightmap_facts *facts;
    const char *folder;
    unsigned formats;
    struct side sides[LIGHTMAP_SIDES];
    int side_count;
};

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

static json_t *map_json(const struct writing *w, int side, int format)
{
    const struct image *image = w->sides[side].image;
    char uri[64];
    snprintf(uri, sizeof uri, "%s.%s", names[side], endings[format]);
    return json_pack("{s:s, s:s, s:s, s:i, s:i, s:f}", "uri", uri, "format", endings[format],
                     "side", sides[side], "width", image->width, "height", image->height, "scale",
                     (double)w->sides[side].scale[format]);
}

static json_t *maps_json(struct gltf_doc *doc, const struct writing *w)
{
    json_t *maps = json_array();
    for (int i = 0; i < FORMATS * w->side_count; i++)
        if (w->formats >> i % FORMATS & 1u &&
            json_array_append_new(maps, map_json(w, i / FORMATS, i % FORMATS)) != 0)
            doc->failed = true;
    return maps;
}

static void describe(struct gltf_doc *doc, const struct writing *w)
{
    json_t *out = json_pack("{s:s, s:s, s:s, s:o, s:o}", "quantity", "irradiance", "unit", "lx",
                            "light", light_text(w->facts), "gi", gltf_doc_text(w->facts->gi),
                            "maps", maps_json(doc, w));
    if (w->facts->samples > 0)
        gltf_doc_set(doc, out, "samples", json_integer((json_int_t)w->facts->samples));
    gltf_doc_set(doc, gltf_doc_child(doc, doc->root, "extras"), LIGHTMAP_EXTRAS, out);
}

static bool give_texture(struct gltf_doc *doc, const struct writing *w)
{
    const struct side *front = &w->sides[LIGHTMAP_FRONT];
    const struct lightmap_image image = { front->png, front->png_size, front->scale[2] };
    return !(w->formats & LIGHTMAP_PNG) || lightmap_materials(doc, &image);
}

static bool write_scene(const struct writing *w, const char *path)
{
    struct gltf_doc doc = { 0 };
    struct host *host = w->map->host;
    bool same;
    bool ok = gltf_doc_of_file(&doc, host, w->scene, &same) &&
              (same || gltf_doc_of_scene(&doc, host, w->scene));
    if (ok) lightmap_forget(&doc);
    ok = ok && lightmap_attach(&doc, &w->map->charts, w->scene) && give_texture(&doc, w);
    if (ok) mark_lights(&doc, w->facts);
    if (ok) describe(&doc, w);
    ok = ok && gltf_doc_write(&doc, path);
    gltf_doc_finish(&doc);
    return ok;
}

// ---- maps

// Text of a map's header.
static int facts_of(const struct writing *w, int side, char samples[16],
                    struct exr_attribute out[MAX_FACTS])
{
    const struct exr_attribute all[] = {
        { "afterglow.quantity", "irradiance" },
        { "afterglow.unit", "lx" },
        { "afterglow.light", light_text(w->facts) },
        { "afterglow.side", sides[side] },
        { "afterglow.gi", w->facts->gi },
        { "afterglow.samples", samples },
    };
    const int count = (int)(sizeof all / sizeof *all) - (w->facts->samples == 0);
    snprintf(samples, 16, "%d", w->facts->samples);
    memcpy(out, all, (size_t)count * sizeof *out);
    return count;
}

static bool write_exr(const struct writing *w, int side, const char *path)
{
    char samples[16];
    struct exr_attribute attributes[MAX_FACTS];
    const struct exr_layer layer = { "color", w->sides[side].image };
    const int count = facts_of(w, side, samples, attributes);
    return exr_write(w->map->host, path, &layer, 1, attributes, count);
}

static bool write_ktx2(const struct writing *w, int side, const char *path)
{
    char samples[16], scale[24];
    struct exr_attribute attributes[MAX_FACTS];
    struct ktx2_entry entries[MAX_FACTS + 1];
    const int count = facts_of(w, side, samples, attributes);
    for (int i = 0; i < count; i++)
        entries[i] = (struct ktx2_entry){ attributes[i].name, attributes[i].value };
    text_float(w->sides[side].scale[1], scale, sizeof scale);
    entries[count] = (struct ktx2_entry){ "afterglow.scale", scale };
    return ktx2_write(w->map->host, path, w->sides[side].image, w->sides[side].scale[1], entries,
                      count + 1);
}

static bool write_png(const struct writing *w, int side, const char *path)
{
    struct file_writer file = { 0 };
    if (!file_begin(&file, w->map->host, path)) return false;
    file_write(&file, w->sides[side].png, w->sides[side].png_size);
    return file_commit(&file);
}

static bool write_map(const struct writing *w, int side, int format)
{
    static bool (*const write[FORMATS])(const struct writing *, int,
                                        const char *) = { write_exr, write_ktx2, write_png };
    if (!(w->formats >> format & 1u)) return true;
    char *path = host_sprintf(w->map->host, "%s/%s.%s", w->folder, names[side], endings[format]);
    const bool ok = path && write[format](w, side, path);
    host_free(w->map->host, path);
    return ok;
}

// ---- all files

static bool prepare(struct writing *w, int side)
{
    struct side *s = &w->sides[side];
    s->image = &w->map->irradiance[side];
    s->scale[0] = 1.0f;
    s->scale[1] = ktx2_scale(s->image);
    return !(w->formats & LIGHTMAP_PNG) ||
           lightmap_texture(w->map->host, s->image, &s->png, &s->png_size, &s->scale[2]);
}

static bool write_record(const struct writing *w)
{
    if (!w->facts->record) return true;
    char *path = host_sprintf(w->map->host, "%s/" LIGHTMAP_RECORD_FILE, w->folder);
    const bool ok = path && lightmap_record_write(w->facts->record, path);
    host_free(w->map->host, path);
    return ok;
}

bool lightmap_write(const struct lightmap *map, const struct scene *scene,
                    const struct lightmap_facts *facts, unsigned formats, const char *folder)
{
    struct writing w = { .map = map,
                         .scene = scene,
                         .facts = facts,
                         .folder = folder,
                         .formats = formats,
                         .side_count = map->has_back ? 2 : 1 };
    bool ok = true;
    for (int side = 0; ok && side < w.side_count; side++) ok = prepare(&w, side);
    for (int i = 0; ok && i < FORMATS * w.side_count; i++)
        ok = write_map(&w, i / FORMATS, i % FORMATS);
    ok = ok && write_record(&w);
    char *path = ok ? host_sprintf(map->host, "%s/%s", folder, LIGHTMAP_SCENE_FILE) : NULL;
    ok = path && write_scene(&w, path);
    host_free(map->host, path);
    for (int side = 0; side < LIGHTMAP_SIDES; side++) host_free(map->host, w.sides[side].png);
    return ok;
}
