// A mip pyramid of linear values. The first level is the exact area average of the image on a grid
// of powers of two, so that each further level is exact too; lookups are bilinear.
#include "frame/emission_map.h"

#include "image/png_file.h"

#include <math.h>

// Conversion of 8-bit texels to linear values.
struct decoder {
    bool mask;
    float cutoff;      // alpha, 0…1
    float linear[256]; // sRGB decoding table
};

static vec3s decode(const struct decoder *d, const uint8_t rgba[4])
{
    if (d->mask) {
        float solid = (float)rgba[3] >= d->cutoff * 255.0f ? 1.0f : 0.0f;
        return vec3_of(solid, solid, solid);
    }
    return vec3_of(d->linear[rgba[0]], d->linear[rgba[1]], d->linear[rgba[2]]);
}

static int power_of_two_within(int size)
{
    int power = 1;
    while (2 * power <= size && 2 * power <= EMISSION_MAP_SIZE) power *= 2;
    return power;
}

// A texel of a row of `from` overlaps one or two texels of a row of `to` ≤ `from`.
struct overlap {
    int first;
    float in_first, in_second;
};

static struct overlap overlap_of(int texel, int from, int to)
{
    double start = (double)texel * to / from, end = (double)(texel + 1) * to / from;
    int first = (int)start;
    double inside = fmin(end, first + 1.0) - start;
    if (first + 1 >= to) inside = end - start;
    return (struct overlap){ first, (float)inside, (float)(end - start - inside) };
}

static void add(vec3s *texel, vec3s value, float weight)
{
    if (weight > 0.0f) *texel = glms_vec3_add(*texel, glms_vec3_scale(value, weight));
}

static void fill_first(struct emission_level *level, const struct scene_image *image,
                       const struct decoder *decoder)
{
    for (int y = 0; y < image->height; y++) {
        struct overlap v = overlap_of(y, image->height, level->height);
        vec3s *upper = level->texels + (size_t)v.first * (size_t)level->width;
        vec3s *lower = v.in_second > 0.0f ? upper + level->width : upper;
        const uint8_t *row = image->rgba + 4 * (size_t)y * (size_t)image->width;
        for (int x = 0; x < image->width; x++) {
            struct overlap u = overlap_of(x, image->width, level->width);
            int second = u.in_second > 0.0f ? u.first + 1 : u.first;
            vec3s value = decode(decoder, row + 4 * (size_t)x);
            add(&upper[u.first], value, u.in_first * v.in_first);
            add(&upper[second], value, u.in_second * v.in_first);
            add(&lower[u.first], value, u.in_first * v.in_second);
            add(&lower[second], value, u.in_second * v.in_second);
        }
    }
}

static void halve(const struct emission_level *from, struct emission_level *to)
{
    int across = from->width / to->width, down = from->height / to->height; // 1 or 2
    for (int y = 0; y < to->height; y++) {
        for (int x = 0; x < to->width; x++) {
            const vec3s *row = from->texels + (size_t)(y * down) * (size_t)from->width;
            const vec3s *next = row + (size_t)(down - 1) * (size_t)from->width;
            int left = x * across, right = left + across - 1;
            vec3s sum = glms_vec3_add(glms_vec3_add(row[left], row[right]),
                                      glms_vec3_add(next[left], next[right]));
            to->texels[y * to->width + x] = glms_vec3_scale(sum, 0.25f);
        }
    }
}

static bool init(struct emission_map *out, struct host *host, const struct scene *scene,
                 const struct texture_use *use, const struct decoder *decoder)
{
    const struct scene_image *image = &scene->images[use->image];
    int width = power_of_two_within(image->width), height = power_of_two_within(image->height);
    *out = (struct emission_map){ .use = use };
    for (;;) {
        struct emission_level *level = &out->levels[out->level_count];
        *level = (struct emission_level){ width, height, NULL };
        level->texels = host_alloc(host, (size_t)width * (size_t)height, sizeof *level->texels);
        if (!level->texels) return false;
        if (out->level_count++ == 0)
            fill_first(level, image, decoder);
        else
            halve(level - 1, level);
        if (width == 1 && height == 1) return true;
        if (width > 1) width /= 2;
        if (height > 1) height /= 2;
    }
}

bool emission_map_init_color(struct emission_map *out, struct host *host, const struct scene *scene,
                             const struct texture_use *use)
{
    const bool linear = scene->images[use->image].linear;
    struct decoder decoder = { 0 };
    for (int i = 0; i < 256; i++) {
        const float value = (float)i / 255.0f;
        decoder.linear[i] = linear ? value : srgb_decode(value);
    }
    return init(out, host, scene, use, &decoder);
}

bool emission_map_init_mask(struct emission_map *out, struct host *host, const struct scene *scene,
                            const struct texture_use *use, float cutoff)
{
    struct decoder decoder = { .mask = true, .cutoff = cutoff };
    return init(out, host, scene, use, &decoder);
}

void emission_map_finish(struct emission_map *map, struct host *host)
{
    for (int i = 0; i < EMISSION_MAP_LEVELS; i++) host_free(host, map->levels[i].texels);
    *map = (struct emission_map){ 0 };
}

// ---- Lookup -------------------------------------------------------------------------------------

vec2s emission_map_uv(const struct emission_map *map, const vec2s *uv0, const vec2s *uv1,
                      uint32_t vertex)
{
    const struct texture_use *t = map->use;
    const vec2s *set = t->uv_set == 1 && uv1 ? uv1 : uv0;
    float u = set ? set[vertex].x : 0.0f, v = set ? set[vertex].y : 0.0f;
    float c = cosf(t->uv_rotation_rad), s = sinf(t->uv_rotation_rad);
    u *= t->uv_scale[0];
    v *= t->uv_scale[1];
    return (vec2s){ { c * u + s * v + t->uv_offset[0], c * v - s * u + t->uv_offset[1] } };
}

// Reduces a coordinate to one period, so that texel indices do not overflow; NaN becomes 0.
static float wrapped(float x, enum texture_wrap wrap)
{
    if (!isfinite(x)) return 0.0f;
    if (wrap == WRAP_CLAMP) return fminf(fmaxf(x, 0.0f), 1.0f);
    return wrap == WRAP_MIRROR ? x - 2.0f * floorf(0.5f * x) : x - floorf(x);
}

static int texel_at(int i, int size, enum texture_wrap wrap)
{
    if (wrap == WRAP_CLAMP) return i < 0 ? 0 : i < size ? i : size - 1;
    int period = wrap == WRAP_MIRROR ? 2 * size : size;
    i = (i % period + period) % period;
    return i < size ? i : period - 1 - i;
}

static vec3s bilinear(const struct emission_level *level, const struct texture_use *use, vec2s uv)
{
    float x = wrapped(uv.x, use->wrap_u) * (float)level->width - 0.5f;
    float y = wrapped(uv.y, use->wrap_v) * (float)level->height - 0.5f;
    int left = (int)floorf(x), top = (int)floorf(y);
    int columns[2], rows[2];
    for (int i = 0; i < 2; i++) {
        columns[i] = texel_at(left + i, level->width, use->wrap_u);
        rows[i] = texel_at(top + i, level->height, use->wrap_v) * level->width;
    }
    float s = x - (float)left, t = y - (float)top;
    const vec3s *texels = level->texels;
    return glms_vec3_lerp(
        glms_vec3_lerp(texels[rows[0] + columns[0]], texels[rows[0] + columns[1]], s),
        glms_vec3_lerp(texels[rows[1] + columns[0]], texels[rows[1] + columns[1]], s), t);
}

vec3s emission_map_mean(const struct emission_map *map, vec2s uv, float area)
{
    int l = 0;
    while (l + 1 < map->level_count &&
           (float)map->levels[l].width * (float)map->levels[l].height * area > 1.0f) {
        l++;
    }
    return bilinear(&map->levels[l], map->use, uv);
}
