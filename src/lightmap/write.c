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
enum { FORMATS = 3, MAX_FACTS = 7 };
static const char *const endings[FORMATS] = { "exr", "ktx2", "png" }; // in the order of the bits

// A side of a page.
struct map {
    int side;
    uint32_t page;
    char name[40]; // of its files, without the ending
    int width, height;
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
    uint32_t page_count;
    struct map *maps; // [map_count] side by side, in each page by page
    size_t map_count;
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

static json_t *map_json(const struct writing *w, const struct map *map, int format)
{
    char uri[64];
    snprintf(uri, sizeof uri, "%s.%s", map->name, endings[format]);
    json_t *out = json_pack("{s:s, s:s, s:s, s:i, s:i, s:f}", "uri", uri, "format", endings[format],
                            "side", sides[map->side], "width", map->width, "height", map->height,
                            "scale", (double)map->scale[format]);
    if (w->page_count > 1) json_object_set_new(out, "page", json_integer(map->page));
    return out;
}

static json_t *maps_json(struct gltf_doc *doc, const struct writing *w)
{
    json_t *maps = json_array();
    for (size_t i = 0; i < w->map_count; i++)
        for (int format = 0; format < FORMATS; format++)
            if (w->formats >> format & 1u &&
                json_array_append_new(maps, map_json(w, &w->maps[i], format)) != 0)
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

// The textures of fronts. Materials on several pages are divided without them, too.
static bool give_textures(struct gltf_doc *doc, const struct writing *w)
{
    if (!(w->formats & LIGHTMAP_PNG) && w->page_count == 1) return true;
    struct lightmap_image *images = host_alloc(w->map->host, w->page_count, sizeof *images);
    for (uint32_t i = 0; images && i < w->page_count; i++)
        images[i] = (struct lightmap_image){ .png = w->maps[i].png,
                                             .size = w->maps[i].png_size,
                                             .range = w->maps[i].scale[2],
                                             .name = w->maps[i].name };
    const bool ok = images && lightmap_materials(doc, images, w->page_count);
    host_free(w->map->host, images);
    return ok;
}

static bool write_scene(const struct writing *w, const char *path)
{
    struct gltf_doc doc = { 0 };
    struct host *host = w->map->host;
    bool same;
    bool ok = gltf_doc_of_file(&doc, host, w->scene, &same) &&
              (same || gltf_doc_of_scene(&doc, host, w->scene));
    if (ok) lightmap_forget(&doc);
    ok = ok && lightmap_attach(&doc, &w->map->charts, w->scene) && give_textures(&doc, w);
    if (ok) mark_lights(&doc, w->facts);
    if (ok) describe(&doc, w);
    ok = ok && gltf_doc_write(&doc, path);
    gltf_doc_finish(&doc);
    return ok;
}

// ---- maps

struct texts {
    char samples[16], page[16], scale[24];
};

// Text of a map's header.
static int facts_of(const struct writing *w, const struct map *map, struct texts *texts,
                    struct exr_attribute out[MAX_FACTS])
{
    const struct exr_attribute all[] = {
        { "afterglow.quantity", "irradiance" },
        { "afterglow.unit", "lx" },
        { "afterglow.light", light_text(w->facts) },
        { "afterglow.side", sides[map->side] },
        { "afterglow.gi", w->facts->gi },
    };
    int count = (int)(sizeof all / sizeof *all);
    memcpy(out, all, sizeof all);
    snprintf(texts->samples, sizeof texts->samples, "%d", w->facts->samples);
    snprintf(texts->page, sizeof texts->page, "%u", map->page);
    if (w->facts->samples > 0)
        out[count++] = (struct exr_attribute){ "afterglow.samples", texts->samples };
    if (w->page_count > 1) out[count++] = (struct exr_attribute){ "afterglow.page", texts->page };
    return count;
}

static bool write_exr(const struct writing *w, const struct map *map, const struct image *image,
                      const char *path)
{
    struct texts texts;
    struct exr_attribute attributes[MAX_FACTS];
    const struct exr_layer layer = { "color", image };
    const int count = facts_of(w, map, &texts, attributes);
    return exr_write(w->map->host, path, &layer, 1, attributes, count);
}

static bool write_ktx2(const struct writing *w, const struct map *map, const struct image *image,
                       const char *path)
{
    struct texts texts;
    struct exr_attribute attributes[MAX_FACTS];
    struct ktx2_entry entries[MAX_FACTS + 1];
    const int count = facts_of(w, map, &texts, attributes);
    for (int i = 0; i < count; i++)
        entries[i] = (struct ktx2_entry){ attributes[i].name, attributes[i].value };
    text_float(map->scale[1], texts.scale, sizeof texts.scale);
    entries[count] = (struct ktx2_entry){ "afterglow.scale", texts.scale };
    return ktx2_write(w->map->host, path, image, map->scale[1], entries, count + 1);
}

static bool write_png(const struct writing *w, const struct map *map, const struct image *image,
                      const char *path)
{
    struct file_writer file = { 0 };
    (void)image; // encoded before
    if (!file_begin(&file, w->map->host, path)) return false;
    file_write(&file, map->png, map->png_size);
    return file_commit(&file);
}

static bool write_file(const struct writing *w, const struct map *map, const struct image *image,
                       int format)
{
    static bool (*const write[FORMATS])(const struct writing *, const struct map *,
                                        const struct image *,
                                        const char *) = { write_exr, write_ktx2, write_png };
    if (!(w->formats >> format & 1u)) return true;
    char *path = host_sprintf(w->map->host, "%s/%s.%s", w->folder, map->name, endings[format]);
    const bool ok = path && write[format](w, map, image, path);
    host_free(w->map->host, path);
    return ok;
}

static bool write_image(const struct writing *w, struct map *map, const struct image *image)
{
    bool ok = true;
    map->width = image->width;
    map->height = image->height;
    map->scale[0] = 1.0f;
    map->scale[1] = ktx2_scale(image);
    if (w->formats & LIGHTMAP_PNG)
        ok = lightmap_texture(w->map->host, image, &map->png, &map->png_size, &map->scale[2]);
    for (int format = 0; ok && format < FORMATS; format++) ok = write_file(w, map, image, format);
    return ok;
}

static bool write_map(const struct writing *w, size_t index)
{
    struct map *map = &w->maps[index];
    map->side = (int)(index / w->page_count);
    map->page = (uint32_t)(index % w->page_count);
    const struct image *all = &w->map->irradiance[map->side];
    if (w->page_count == 1) {
        snprintf(map->name, sizeof map->name, "%s", names[map->side]);
        return write_image(w, map, all);
    }
    const struct chart_page at = charts_page(&w->map->charts, map->page);
    struct image page = { 0 };
    snprintf(map->name, sizeof map->name, "%s.%u", names[map->side], map->page);
    const bool ok =
        image_part(&page, w->map->host, all, (int)at.x, (int)at.y, (int)at.width, (int)at.height) &&
        write_image(w, map, &page);
    image_finish(&page, w->map->host);
    return ok;
}

// ---- all files

static bool write_record(const struct writing *w)
{
    if (!w->facts->record) return true;
    char *path = host_sprintf(w->map->host, "%s/" LIGHTMAP_RECORD_FILE, w->folder);
    const bool ok = path && lightmap_record_write(w->facts->record, path);
    host_free(w->map->host, path);
    return ok;
}

static bool write_maps(struct writing *w)
{
    w->maps = host_alloc(w->map->host, w->map_count, sizeof *w->maps);
    bool ok = w->maps;
    for (size_t i = 0; ok && i < w->map_count; i++) ok = write_map(w, i);
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
                         .page_count = charts_page_count(&map->charts) };
    w.map_count = (size_t)w.page_count * (map->has_back ? 2 : 1);
    bool ok = write_maps(&w) && write_record(&w);
    char *path = ok ? host_sprintf(map->host, "%s/%s", folder, LIGHTMAP_SCENE_FILE) : NULL;
    ok = path && write_scene(&w, path);
    host_free(map->host, path);
    for (size_t i = 0; w.maps && i < w.map_count; i++) host_free(map->host, w.maps[i].png);
    host_free(map->host, w.maps);
    return ok;
}
