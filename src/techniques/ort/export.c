#include "techniques/ort/export.h"

#include "core/half.h"
#include "image/exr.h"
#include "scene/statics.h"

#include <stdio.h>
#include <string.h>

// ---- images

static void fill_piece(const struct ort_export *e, const struct ort_piece *piece, struct image *out)
{
    for (uint32_t y = 0; y < piece->height; y++)
        for (uint32_t x = 0; x < piece->width; x++) {
            const struct ort_place at = { piece->x + x, piece->y + y };
            float *pixel = image_at(out, (int)(piece->bin_x + x), (int)(piece->bin_y + y));
            size_t weight;
            if (!ort_maps_at(&e->maps, piece->map, at, &weight)) continue;
            for (size_t c = 0; c < 3; c++) pixel[c] = float_from_half(e->maps.weight[weight + c]);
        }
}

// Returns the first piece of the next bin.
static uint32_t fill_bin(const struct ort_export *e, uint32_t bin, uint32_t first,
                         struct image *out)
{
    uint32_t p = first;
    memset(out->pixels, 0, sizeof(float[3]) * ORT_BIN_SIDE * ORT_BIN_SIDE);
    for (; p < e->bins.piece_count && e->bins.pieces[p].bin == bin; p++)
        fill_piece(e, &e->bins.pieces[p], out);
    return p;
}

static bool write_bin(const struct ort_export *e, uint32_t bin, const struct image *image)
{
    char name[24], scale[16];
    snprintf(name, sizeof name, ORT_EXPORT_BIN, bin);
    snprintf(scale, sizeof scale, "%g", (double)ORT_MAP_SCALE);
    const struct exr_layer layer = { "color", image };
    const struct exr_attribute attributes[] = {
        { "afterglow.quantity", "transfer weight" },
        { "afterglow.scale", scale },
    };
    char *path = host_sprintf(e->host, "%s/%s", e->folder, name);
    const bool ok = path && exr_write_half(e->host, path, &layer, 1, attributes,
                                           sizeof attributes / sizeof *attributes);
    host_free(e->host, path);
    return ok;
}

static bool write_bins(const struct ort_export *e)
{
    struct image image = { 0 };
    bool ok = image_init(&image, e->host, ORT_BIN_SIDE, ORT_BIN_SIDE, 3);
    for (uint32_t bin = 0, piece = 0; ok && bin < e->bins.bin_count; bin++) {
        piece = fill_bin(e, bin, piece, &image);
        ok = write_bin(e, bin, &image);
    }
    image_finish(&image, e->host);
    return ok;
}

// ---- content

static bool make_map(struct ort_export *e, const struct scene_pose *pose)
{
    struct scene_statics statics;
    const bool ok = scene_statics_init(&statics, e->host, pose) &&
                    ort_map_init(&e->map, e->host, &statics.pose, e->options);
    scene_statics_finish(&statics);
    return ok;
}

static bool find_content(struct ort_export *e, const struct tensors *bake)
{
    return (e->energy = TENSORS_EXPECT(e->host, bake, ORT_ENERGY, TENSOR_F32, 2, 3)) &&
           ort_maps_find(&e->maps, &e->map, e->options, bake);
}

// An empty scene has none.
static bool pack(struct ort_export *e)
{
    const struct ort_bins_wish wish = { .maps = e->maps.count,
                                        .width = e->map.width,
                                        .height = e->map.height,
                                        .mask = ort_maps_mask,
                                        .user = &e->maps };
    return e->map.texel_count == 0 || ort_bins_init(&e->bins, e->host, &wish);
}

bool ort_bake_export(struct host *host, const struct tensors *bake,
                     const struct technique_bake *how, const char *folder)
{
    struct ort_export e = { .host = host, .folder = folder, .options = how->options };
    const bool ok = make_map(&e, how->pose) && find_content(&e, bake) && pack(&e) &&
                    write_bins(&e) && ort_export_index(&e);
    ort_bins_finish(&e.bins);
    ort_map_finish(&e.map);
    return ok;
}
