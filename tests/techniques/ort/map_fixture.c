#include "techniques/ort/map_fixture.h"

#include "framework/test.h"

#include "core/rng.h"

#include <math.h>
#include <string.h>

struct shape {
    int x, y, width, height;
    bool ellipse;
};

static bool holds(const struct shape *s, int x, int y)
{
    const float u = (2.0f * (float)(x - s->x) + 1.0f) / (float)s->width - 1.0f;
    const float v = (2.0f * (float)(y - s->y) + 1.0f) / (float)s->height - 1.0f;
    return s->ellipse ? u * u + v * v <= 1.0f : fabsf(u) <= 1.0f && fabsf(v) <= 1.0f;
}

// Sets the texels of a shape in an image and returns their number.
static uint64_t draw(const struct test_maps *maps, uint8_t *image, const struct shape *s)
{
    uint64_t texels = 0;
    for (int y = s->y < 0 ? 0 : s->y; y < s->y + s->height && y < (int)maps->height; y++)
        for (int x = s->x < 0 ? 0 : s->x; x < s->x + s->width && x < (int)maps->width; x++) {
            if (!holds(s, x, y)) continue;
            image[(size_t)y * maps->width + (size_t)x] = 1;
            texels++;
        }
    return texels;
}

// ---- an atlas

static bool is_free(const struct test_maps *maps, const struct shape *s)
{
    if (s->x < 0 || s->y < 0 || s->x + s->width > (int)maps->width ||
        s->y + s->height > (int)maps->height)
        return false;
    for (int y = s->y; y < s->y + s->height; y++)
        for (int x = s->x; x < s->x + s->width; x++)
            if (maps->atlas[(size_t)y * maps->width + (size_t)x]) return false;
    return true;
}

// Islands become smaller from attempt to attempt.
static void fill_atlas(struct test_maps *maps)
{
    const uint64_t wanted = (uint64_t)maps->width * maps->height * 65 / 100;
    const float width = (float)maps->width, height = (float)maps->height;
    struct rng rng = rng_for(maps->seed, 0, 0);
    uint64_t texels = 0;
    for (int i = 0; texels < wanted && i < 5000; i++) {
        const float side = i < 20 ? 0.25f : i < 200 ? 0.12f : 0.05f;
        struct shape s = { .width = 2 + (int)(side * (0.3f + rng_float(&rng)) * width),
                           .height = 2 + (int)(side * (0.3f + rng_float(&rng)) * height),
                           .ellipse = i % 3 == 0 };
        s.x = (int)(rng_float(&rng) * (width - (float)s.width));
        s.y = (int)(rng_float(&rng) * (height - (float)s.height));
        if (is_free(maps, &s)) texels += draw(maps, maps->atlas, &s);
    }
}

struct test_maps test_maps_of(enum map_kind kind, uint32_t width, uint32_t height, uint32_t seed)
{
    struct test_maps maps = { .kind = kind, .width = width, .height = height, .seed = seed };
    if (kind != MAP_ISLANDS) return maps;
    maps.atlas = host_alloc(test_host(), (size_t)width * height, 1);
    assert_non_null(maps.atlas);
    fill_atlas(&maps);
    return maps;
}

void test_maps_finish(struct test_maps *maps)
{
    host_free(test_host(), maps->atlas);
}

// ---- masks

// An offset of −0.9 to 0.9 of a side, more often near 0.
static int draw_offset(struct rng *rng, uint32_t side)
{
    const float u = 2.0f * rng_float(rng) - 1.0f;
    return (int)(u * fabsf(u) * 0.9f * (float)side);
}

static void mask_islands(const struct test_maps *maps, struct rng *rng, uint8_t *mask)
{
    const int width = (int)maps->width, height = (int)maps->height;
    const int dx = draw_offset(rng, maps->width), dy = draw_offset(rng, maps->height);
    for (int y = 0; y < height; y++) {
        if (y + dy < 0 || y + dy >= height) continue;
        const uint8_t *row = maps->atlas + (ptrdiff_t)y * width;
        const uint8_t *shifted = maps->atlas + (ptrdiff_t)(y + dy) * width;
        uint8_t *out = mask + (ptrdiff_t)y * width;
        for (int x = dx < 0 ? -dx : 0; x < width && x + dx < width; x++)
            out[x] = row[x] && shifted[x + dx];
    }
}

static void mask_discs(const struct test_maps *maps, struct rng *rng, uint8_t *mask)
{
    for (int i = 0; i < 5; i++) {
        struct shape s = { .ellipse = true };
        s.width = s.height = 1 + (int)(rng_float(rng) * 0.3f * (float)maps->width);
        s.x = (int)(rng_float(rng) * (float)maps->width);
        s.y = (int)(rng_float(rng) * (float)maps->height);
        draw(maps, mask, &s);
    }
}

static bool texel_of(const struct test_maps *maps, uint32_t map, struct rng *rng, uint32_t x,
                     uint32_t y)
{
    const float u = (2.0f * (float)x + 1.0f) / (float)maps->width - 1.0f;
    const float v = (2.0f * (float)y + 1.0f) / (float)maps->height - 1.0f;
    switch (maps->kind) {
    case MAP_FULL:
        return maps->rows == 0 || y < maps->rows;
    case MAP_DOTS:
        return rng_u32(rng) % 50 == 0;
    case MAP_STRIPES:
        return (map % 2 ? x : y) / 20 % 3 == map % 3;
    case MAP_RING:
        return u * u + v * v <= 1.0f && u * u + v * v >= 0.7f;
    default:
        return false;
    }
}

bool test_maps_mask(void *user, uint32_t map, uint8_t *mask)
{
    const struct test_maps *maps = user;
    struct rng rng = rng_for(maps->seed, map, 1);
    if (map + 1 == maps->fails) return false;
    memset(mask, 0, (size_t)maps->width * maps->height);
    if (maps->kind == MAP_ISLANDS)
        mask_islands(maps, &rng, mask);
    else if (maps->kind == MAP_DISCS)
        mask_discs(maps, &rng, mask);
    else if (maps->kind != MAP_EMPTY)
        for (uint32_t y = 0; y < maps->height; y++)
            for (uint32_t x = 0; x < maps->width; x++)
                mask[(size_t)y * maps->width + x] = texel_of(maps, map, &rng, x, y);
    return true;
}
