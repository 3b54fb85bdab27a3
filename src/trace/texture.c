// Material textures: mip chains and trilinear filtering.
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
    return (vec4s){ { t->decode[p[0]], t->decode[p[1]], t->decode[p[2]], t->unit[p[3]] } };
}

// glms_vec4_lerp also clamps the weight.
static vec4s mix(vec4s a, vec4s b, float t)
{
    return (vec4s){ { a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z),
                      a.w + t * (b.w - a.w) } };
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
    vec4s top = mix(fetch(t, level, x[0], y[0]), fetch(t, level, x[1], y[0]), fx);
    vec4s low = mix(fetch(t, level, x[0], y[1]), fetch(t, level, x[1], y[1]), fx);
    return mix(top, low, fy);
}

// Downsamples a level as a linear blit does: the mean of 2 × 2 texels for even sizes.
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

void texture_init(struct texture *t, const struct scene_image *image, bool srgb)
{
    *t = (struct texture){ .width = image->width, .height = image->height, .srgb = srgb };
    for (int i = 0; i < 256; i++) {
        float v = (float)i / 255.0f;
        t->unit[i] = v;
        t->decode[i] = srgb ? srgb_decode(v) : v;
    }
    t->levels = 1;
    t->texels[0] = image->rgba;
}

bool texture_add_levels(struct texture *t, struct host *host)
{
    size_t bytes = 0;
    int width = t->width, height = t->height, levels = 1;
    while ((width > 1 || height > 1) && levels < TEXTURE_LEVELS) {
        width = halved(width);
        height = halved(height);
        bytes += 4 * (size_t)width * (size_t)height; // below SCENE_MAX_IMAGE_SIZE² · 4
        levels++;
    }
    if (bytes == 0 || t->owned) return true;
    t->owned = host_alloc(host, bytes, 1);
    if (!t->owned) return false;
    t->levels = levels;
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

// floorf without a call, for |x| < 2³¹.
static inline int floor_int(float x)
{
    int i = (int)x;
    return i - (x < (float)i);
}

// Brings a coordinate into 0…1 (repeat) or 0…2 (mirror), so that its texel index is an int at most
// one texel outside.
static float normalized_coordinate(float u, enum texture_wrap how)
{
    if (how == WRAP_CLAMP) return u > -1.0f ? u < 2.0f ? u : 2.0f : -1.0f;
    if (!(fabsf(u) < 0x1p24f)) return 0.0f; // integers from here on, or NaN
    if (how == WRAP_MIRROR) return u - 2.0f * (float)floor_int(0.5f * u);
    return u - (float)floor_int(u);
}

// Wraps the texel index of a normalized coordinate.
static inline int wrap(int i, int size, enum texture_wrap how)
{
    if (how == WRAP_REPEAT) return i < 0 ? i + size : i >= size ? i - size : i;
    if (how == WRAP_CLAMP) return i < 0 ? 0 : i >= size ? size - 1 : i;
    i = i < 0 ? -1 - i : i; // mirrored at 0, `size` and 2 · `size`
    if (i >= 2 * size) i -= 2 * size;
    return i < size ? i : 2 * size - 1 - i;
}

static vec4s sample_level(const struct texture_map *map, int level, float u, float v)
{
    const struct texture *t = map->texture;
    int width = level_size(t->width, level), height = level_size(t->height, level);
    float x = u * (float)width, y = v * (float)height;
    if (map->nearest)
        return fetch(t, level, wrap(floor_int(x), width, map->wrap_u),
                     wrap(floor_int(y), height, map->wrap_v));
    x -= 0.5f;
    y -= 0.5f;
    int left = floor_int(x), top = floor_int(y);
    int tx[2] = { wrap(left, width, map->wrap_u), wrap(left + 1, width, map->wrap_u) };
    int ty[2] = { wrap(top, height, map->wrap_v), wrap(top + 1, height, map->wrap_v) };
    return blend(t, level, tx, ty, x - (float)left, y - (float)top);
}

static vec2s transformed(const struct texture_map *map, vec2s uv, float one)
{
    vec3s p = vec3_of(uv.x, uv.y, one);
    return (vec2s){ { glms_vec3_dot(map->row_u, p), glms_vec3_dot(map->row_v, p) } };
}

// Vulkan 1.3, sec. 16.5.6: log2 of the longer pixel footprint axis in texels.
float texture_level(const struct texture_map *map, vec2s dx, vec2s dy)
{
    const struct texture *t = map->texture;
    vec2s size = { { (float)t->width, (float)t->height } };
    float x = glms_vec2_norm2(glms_vec2_mul(transformed(map, dx, 0.0f), size));
    float y = glms_vec2_norm2(glms_vec2_mul(transformed(map, dy, 0.0f), size));
    float longest2 = fmaxf(x, y);
    if (!(longest2 > 1.0f)) return 0.0f;
    return fminf(0.5f * log2f(longest2), (float)(t->levels - 1));
}

vec4s texture_sample(const struct texture_map *map, vec2s uv, float level)
{
    vec2s at = transformed(map, uv, 1.0f);
    float u = normalized_coordinate(at.x, map->wrap_u),
          v = normalized_coordinate(at.y, map->wrap_v);
    if (map->nearest) return sample_level(map, (int)(level + 0.5f), u, v);
    int low = (int)level;
    vec4s a = sample_level(map, low, u, v);
    if (level == (float)low) return a;
    return mix(a, sample_level(map, low + 1, u, v), level - (float)low);
}

static const uint8_t *texel(const struct texture *t, int x, int y)
{
    return t->texels[0] + 4 * ((size_t)y * (size_t)t->width + (size_t)x);
}

// Prefetches both rows, but not a right neighbour in the next cache line.
void texture_prefetch(const struct texture_map *map, vec2s uv)
{
    const struct texture *t = map->texture;
    vec2s at = transformed(map, uv, 1.0f);
    float x = normalized_coordinate(at.x, map->wrap_u) * (float)t->width - 0.5f,
          y = normalized_coordinate(at.y, map->wrap_v) * (float)t->height - 0.5f;
    int left = wrap(floor_int(x), t->width, map->wrap_u), top = floor_int(y);
    __builtin_prefetch(texel(t, left, wrap(top, t->height, map->wrap_v)));
    __builtin_prefetch(texel(t, left, wrap(top + 1, t->height, map->wrap_v)));
}
