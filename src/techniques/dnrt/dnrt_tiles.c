// Which tiles of the image an object reaches: those of the rectangle around the corners of its
// outer volume. Pixels of its own are in the rectangle around its bounding sphere.
#include "techniques/dnrt/dnrt_state.h"

#include "core/saturate.h"

#include <math.h>
#include <string.h>

struct rectangle {
    int first[2], end[2]; // in tiles
};

static int tiles_of(uint32_t pixels)
{
    return (int)gpu_groups(pixels, DNRT_TILE);
}

static vec3s corner_of(const struct dnrt_gpu_object *object, mat3s axes, float half, int corner)
{
    vec3s p = object->centre;
    for (int i = 0; i < 3; i++)
        p = glms_vec3_muladds(axes.col[i], corner >> i & 1 ? half : -half, p);
    return p;
}

// All of the image where a corner is behind the near plane, and none where all are.
static struct rectangle rectangle_of(const struct frame_view *view,
                                     const struct dnrt_gpu_object *object, float half)
{
    const int tiles[2] = { tiles_of(view->width), tiles_of(view->height) };
    const uint32_t size[2] = { view->width, view->height };
    float least[2] = { INFINITY, INFINITY }, most[2] = { -INFINITY, -INFINITY };
    const float *q = object->rotation;
    const mat3s axes = glms_quat_mat3((versors){ .raw = { q[0], q[1], q[2], q[3] } });
    int behind = 0;
    for (int k = 0; k < 8; k++) {
        const vec3s corner = corner_of(object, axes, half, k);
        const vec4s clip = glms_mat4_mulv(view->constants->clip_from_world, vec4_of(corner, 1));
        if (!(glms_vec3_dot(glms_vec3_sub(corner, view->camera.eye), view->camera.forward) >
              view->camera.near_m)) {
            behind++;
            continue;
        }
        for (int i = 0; i < 2; i++) {
            least[i] = fminf(least[i], clip.raw[i] / clip.w);
            most[i] = fmaxf(most[i], clip.raw[i] / clip.w);
        }
    }
    struct rectangle r = { { 0, 0 }, { tiles[0], tiles[1] } };
    for (int i = 0; i < 2; i++) {
        if (behind == 8) r.end[i] = 0;
        if (behind > 0) continue;
        const float scale = 0.5f * (float)size[i] / DNRT_TILE;
        r.first[i] = int_saturated((double)((least[i] + 1.0f) * scale), 0, tiles[i]);
        r.end[i] = int_saturated((double)(floorf((most[i] + 1.0f) * scale) + 1.0f), 0, tiles[i]);
    }
    return r;
}

// Positive floats are ordered as their bits.
static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

struct tile_list {
    uint32_t *words;
    int across;
    size_t stride;
};

static uint32_t *tile_at(const struct tile_list *tiles, int x, int y)
{
    return tiles->words + (size_t)(y * tiles->across + x) * tiles->stride;
}

static void mark(const struct tile_list *tiles, struct rectangle r, int object, float share_m)
{
    const uint32_t share = bits_of(share_m);
    for (int y = r.first[1]; y < r.end[1]; y++)
        for (int x = r.first[0]; x < r.end[0]; x++) {
            uint32_t *tile = tile_at(tiles, x, y);
            if (tile[1] == 0 || share < tile[1]) tile[1] = share;
            tile[DNRT_TILE_BITS + object / 32] |= 1u << object % 32;
        }
}

static void mark_own(const struct tile_list *tiles, struct rectangle r)
{
    for (int y = r.first[1]; y < r.end[1]; y++)
        for (int x = r.first[0]; x < r.end[0]; x++) tile_at(tiles, x, y)[0] = 1;
}

static void swap_words(uint32_t *a, uint32_t *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t word = a[i];
        a[i] = b[i];
        b[i] = word;
    }
}

// Moves those with a bit to the front, before them those with pixels of objects.
static struct dnrt_tile_counts sort_marked(const struct tile_list *tiles, uint32_t count)
{
    struct dnrt_tile_counts counts = { 0, 0 };
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *from = tiles->words + t * tiles->stride;
        const bool own = from[0] != 0;
        uint32_t any = 0;
        for (size_t w = DNRT_TILE_BITS; w < tiles->stride; w++) any |= from[w];
        if (any == 0) continue;
        uint32_t *to = tiles->words + counts.all++ * tiles->stride;
        memmove(to, from, tiles->stride * sizeof *to);
        to[0] = t;
        if (own) swap_words(to, tiles->words + counts.own++ * tiles->stride, tiles->stride);
    }
    return counts;
}

bool dnrt_in_view(const struct dnrt *s, const struct frame_view *view, int object)
{
    const struct dnrt_gpu_object *of = &s->gpu_objects[object];
    const struct rectangle r = rectangle_of(view, of, of->half_m * s->options.fade);
    return r.first[0] < r.end[0] && r.first[1] < r.end[1];
}

// Largest extent of pixels that share a lookup, over the distance of two samples.
static const float SHARE = 0.5f;

// Factor of the bounding sphere's radius, for rounded positions.
static const float OWN_MARGIN = 1.02f;

struct dnrt_tile_counts dnrt_find_tiles(const struct dnrt *s, const struct frame_view *view,
                                        uint32_t words, uint32_t *at)
{
    const int across = tiles_of(view->width);
    const struct tile_list tiles = { at, across, DNRT_TILE_BITS + words };
    const uint32_t count = (uint32_t)(across * tiles_of(view->height));
    memset(at, 0, count * tiles.stride * sizeof *at);
    for (int i = 0; i < s->objects.count; i++) {
        const struct dnrt_gpu_object *object = &s->gpu_objects[i];
        const float half = object->half_m * s->options.fade;
        const float cell_m = 2.0f * object->half_m / (float)(dnrt_size(&s->options) - 1);
        // A deformed object is anywhere about the sphere of its bake.
        const float own =
            s->objects.at[i].deformed ? half : OWN_MARGIN * object->half_m / s->options.reach;
        if (object->shape < 0 || !(half > 0.0f)) continue;
        mark(&tiles, rectangle_of(view, object, half), i, SHARE * cell_m);
        mark_own(&tiles, rectangle_of(view, object, own));
    }
    return sort_marked(&tiles, count);
}
