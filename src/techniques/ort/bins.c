#include "techniques/ort/bins.h"

#include "techniques/ort/crop.h"
#include "techniques/ort/pack.h"
#include "techniques/ort/slices.h"
#include "techniques/ort/tiles.h"

#include "core/host.h"

#include <assert.h>

// Scratch memory of a map.
struct scratch {
    struct ort_cover cover;
    struct ort_crop crop;
    uint8_t *mask;
};

static bool scratch_init(struct scratch *s, struct host *host, uint32_t width, uint32_t height)
{
    s->mask = host_alloc(host, (size_t)width * height, sizeof *s->mask);
    return s->mask && ort_cover_init(&s->cover, host, width, height) &&
           ort_crop_init(&s->crop, host, &s->cover);
}

static void scratch_finish(struct scratch *s, struct host *host)
{
    ort_crop_finish(&s->crop);
    ort_cover_finish(&s->cover);
    host_free(host, s->mask);
}

static bool add_boxes(struct scratch *s, uint32_t map, struct ort_pieces *pieces)
{
    if (!ort_crop_map(&s->crop)) return false;
    for (size_t i = 0; i < s->crop.box_count; i++)
        if (!ort_slices_add(pieces, &s->cover, map, &s->crop.nodes[i].box)) return false;
    return true;
}

static uint64_t texels_of(const struct ort_pieces *pieces)
{
    uint64_t texels = 0;
    for (uint32_t i = 0; i < pieces->count; i++)
        texels += (uint64_t)pieces->at[i].width * pieces->at[i].height;
    return texels;
}

// The pieces of all maps, without a place.
static bool add_maps(struct ort_bins *out, const struct ort_bins_wish *wish,
                     struct ort_pieces *pieces)
{
    struct scratch s = { 0 };
    bool ok = scratch_init(&s, out->host, wish->width, wish->height);
    for (uint32_t map = 0; ok && map < wish->maps; map++) {
        ok = wish->mask(wish->user, map, s.mask);
        if (!ok) break;
        out->occupied += ort_cover_set(&s.cover, s.mask);
        ok = wish->tile_rows > 0 ? ort_tiles_add(pieces, &s.cover, map, wish->tile_rows)
                                 : add_boxes(&s, map, pieces);
    }
    scratch_finish(&s, out->host);
    return ok;
}

bool ort_bins_init(struct ort_bins *out, struct host *host, const struct ort_bins_wish *wish)
{
    assert(wish->width > 0 && wish->width <= ORT_MAX_MAP_SIDE);
    assert(wish->height > 0 && wish->height <= ORT_MAX_MAP_SIDE);
    assert(wish->tile_rows == 0 || ORT_BIN_SIDE % wish->tile_rows == 0);
    struct ort_pieces pieces = { .host = host };
    *out = (struct ort_bins){ .host = host };
    bool ok = add_maps(out, wish, &pieces);
    if (ok && wish->tile_rows > 0)
        out->bin_count = ort_tiles_pack(&pieces, wish->tile_rows);
    else
        ok = ok && ort_pack(&pieces, &out->bin_count, &out->cuts);
    out->packed = texels_of(&pieces);
    out->pieces = pieces.at;
    out->piece_count = pieces.count;
    if (!ok) ort_bins_finish(out);
    return ok;
}

void ort_bins_finish(struct ort_bins *bins)
{
    if (!bins->host) return;
    host_free(bins->host, bins->pieces);
    *bins = (struct ort_bins){ 0 };
}
