// Maps of materials: mip chains and trilinear filtering.
#include "trace/texture.h"

#include "image/png_file.h"

#include <math.h>

// ---- mip chains

static int halved(int size)
{
    return size > 1 ? size / 2 : 1;
}

static int level_size(int size, int level)
{
    int s = size >> level;
    return s > 0 ? s : 1;
}

static vec4s fetch(const struct texture *t, int level, int x, int y)
{
    size_t width = (size_t)level_size(t->width, level);
    const uint8_t *p = t->texels[level] + 4 * ((size_t)y * width + (size_t)x);
    return (vec4s){ { t->decode[p[0]], t->decode[p[1]], t->decode[p[2]], (float)p[3] / 255.0f } };
}

static uint8_t to_byte(float v)
{
    return (uint8_t)lrintf(fminf(fmaxf(v, 0.0f), 1.0f) * 255.0f);
}

// The two texels that a linear filter reads at `x` (texel centres at whole numbers and a half),
// clamped.
static float taps(float x, int size, int out[2])
{
    float at = x - 0.5f, low = floorf(at);
    int i = (int)low;
    out[0] = i < 0 ? 0 : i >= size ? size - 1 : i;
    out[1] = i + 1 < 0 ? 0 : i + 1 >= size ? size - 1 : i + 1;
    return at - low;
}

static vec4s blend(const struct texture *t, int level, const int x[2], const int y[2], float fx,
                   float fy)
{
    vec4s top = glms_vec4_lerp(fetch(t, level, x[0], y[0]), fetch(t, level, x[1], y[0]), fx);
    vec4s low = glms_vec4_lerp(fetch(t, level, x[0], y[1]), fetch(t, level, x[1], y[1]), fx);
    return glms_vec4_lerp(top, low, fy);
}

// A level from the one above it, as a linear blit makes it: the mean of 2 × 2 where sizes are even.
static void fill_level(const struct texture *t, int level, uint8_t *out)
{
    int width = level_size(t->width, level), height = level_size(t->height, level);
    int from_width = level_size(t->width, level - 1),
        from_height = level_size(t->height, level - 1);
    float scale_x = (float)from_width / (float)width, scale_y = (float)from_height / (float)height;
    for (int y = 0; y < height; y++) {
        int ty[2];
        float fy = taps(((float)y + 0.5f) * scale_y, from_height, ty);
        for (int x = 0; x < width; x++, out += 4) {
            int tx[2];
            float fx = taps(((float)x + 0.5f) * scale_x, from_width, tx);
            vec4s v = blend(t, level - 1, tx, ty, fx, fy);
            for (int c = 0; c < 3; c++)
                out[c] = to_byte(t->srgb ? srgb_encode(v.raw[c]) : v.raw[c]);
            out[3] = to_byte(v.w);
        }
    }
}

bool texture_init(struct texture *t, struct host *host, const struct scene_image *image, bool srgb)
{
    *t = (struct texture){ .width = image->width, .height = image->height, .srgb = srgb };
    for (int i = 0; i < 256; i++) {
        float v = (float)i / 255.0f;
        t->decode[i] = srgb ? srgb_decode(v) : v;
    }
    t->levels = 1;
    t->texels[0] = image->rgba;
    size_t bytes = 0;
    int width = image->width, height = image->height;
    while ((width > 1 || height > 1) && t->levels < TEXTURE_LEVELS) {
        width = halved(width);
        height = halved(height);
        bytes += 4 * (size_t)width * (size_t)height; // below SCENE_MAX_IMAGE_SIZE² · 4
        t->levels++;
    }
    if (bytes == 0) return true;
    t->owned = host_alloc(host, bytes, 1);
    if (!t->owned) return false;
    uint8_t *at = t->owned;
    for (int level = 1; level < t->levels; level++) {
        fill_level(t, level, at);
        t->texels[level] = at;
        at += 4 * (size_t)level_size(t->width, level) * (size_t)level_size(t->height, level);
    }
    return true;
}

void texture_finish(struct texture *texture, struct host *host)
{
    host_free(host, texture->owned);
    *texture = (struct texture){ 0 };
}

// ---- sampling

// offset + rotation · scale · uv, the rotation counter-clockwise in the image (v down).
struct texture_map texture_map_of(const struct texture_use *use, const struct texture *texture)
{
    float c = cosf(use->uv_rotation_rad), s = sinf(use->uv_rotation_rad);
    return (struct texture_map){
        .texture = texture,
        .uv_set = use->uv_set,
        .row_u = vec3_of(c * use->uv_scale[0], s * use->uv_scale[1], use->uv_offset[0]),
        .row_v = vec3_of(-s * use->uv_scale[0], c * use->uv_scale[1], use->uv_offset[1]),
        .wrap_u = use->wrap_u,
        .wrap_v = use->wrap_v,
        .nearest = use->nearest,
    };
}

// A texel index of any size brought into the image.
static int wrap(int i, int size, enum texture_wrap how)
{
    if (how == WRAP_CLAMP) return i < 0 ? 0 : i >= size ? size - 1 : i;
    int period = how == WRAP_MIRROR ? 2 * size : size;
    i %= period;
    if (i < 0) i += period;
    return i < size ? i : period - 1 - i;
}

// A coordinate near enough to 0 that its texel index is an int; repeats lose nothing by that.
static float tame(float u, enum texture_wrap how)
{
    if (!isfinite(u)) return 0.0f;
    if (how == WRAP_CLAMP) return fminf(fmaxf(u, -1.0f), 2.0f);
    return u - 2.0f * floorf(0.5f * u);
}

static vec4s sample_level(const struct texture_map *map, int level, float u, float v)
{
    const struct texture *t = map->texture;
    int width = level_size(t->width, level), height = level_size(t->height, level);
    float x = u * (float)width, y = v * (float)height;
    if (map->nearest)
        return fetch(t, level, wrap((int)floorf(x), width, map->wrap_u),
                     wrap((int)floorf(y), height, map->wrap_v));
    float left = floorf(x - 0.5f), top = floorf(y - 0.5f);
    int tx[2] = { wrap((int)left, width, map->wrap_u), wrap((int)left + 1, width, map->wrap_u) };
    int ty[2] = { wrap((int)top, height, map->wrap_v), wrap((int)top + 1, height, map->wrap_v) };
    return blend(t, level, tx, ty, x - 0.5f - left, y - 0.5f - top);
}

static vec2s transformed(const struct texture_map *map, vec2s uv, float one)
{
    vec3s p = vec3_of(uv.x, uv.y, one);
    return (vec2s){ { glms_vec3_dot(map->row_u, p), glms_vec3_dot(map->row_v, p) } };
}

// Vulkan 1.3, sec. 16.5.6: log2 of the longer of the pixel's two steps in texels.
static float level_of(const struct texture_map *map, vec2s dx, vec2s dy)
{
    const struct texture *t = map->texture;
    vec2s size = { { (float)t->width, (float)t->height } };
    float x = glms_vec2_norm2(glms_vec2_mul(transformed(map, dx, 0.0f), size));
    float y = glms_vec2_norm2(glms_vec2_mul(transformed(map, dy, 0.0f), size));
    float longest2 = fmaxf(x, y);
    if (!(longest2 > 1.0f)) return 0.0f;
    return fminf(0.5f * log2f(longest2), (float)(t->levels - 1));
}

vec4s texture_sample(const struct texture_map *map, vec2s uv, vec2s dx, vec2s dy)
{
    vec2s at = transformed(map, uv, 1.0f);
    float u = tame(at.x, map->wrap_u), v = tame(at.y, map->wrap_v);
    float level = level_of(map, dx, dy);
    if (map->nearest) return sample_level(map, (int)(level + 0.5f), u, v);
    int low = (int)level;
    vec4s a = sample_level(map, low, u, v);
    if (level == (float)low) return a;
    return glms_vec4_lerp(a, sample_level(map, low + 1, u, v), level - (float)low);
}
