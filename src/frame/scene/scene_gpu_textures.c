// Textures of a scene: each image as colours (sRGB), as data, as normals or as several of them,
// depending on its materials, with full mip chains generated on the GPU. Alpha is averaged like any
// other channel.
//
// Normals have 16-bit floats: filters of 8-bit textures may round every product down, as lavapipe's
// do, which turns normals by half a degree to one side.
#include "frame/scene/scene_gpu_build.h"

#include <math.h>

static bool is_color(int map)
{
    return map == SCENE_MAP_BASE_COLOR || map == SCENE_MAP_EMISSIVE ||
           map == SCENE_MAP_SPECULAR_COLOR;
}

static const struct texture_use *use_of(const struct material *m, int map)
{
    switch (map) {
    case SCENE_MAP_BASE_COLOR:
        return &m->base_color_map;
    case SCENE_MAP_METALLIC_ROUGHNESS:
        return &m->metallic_roughness_map;
    case SCENE_MAP_NORMAL:
        return &m->normal_map;
    case SCENE_MAP_SPECULAR:
        return &m->specular_map;
    case SCENE_MAP_SPECULAR_COLOR:
        return &m->specular_color_map;
    default:
        return &m->emissive_map;
    }
}

static uint32_t mip_count(int width, int height)
{
    uint32_t count = 1;
    for (int size = width > height ? width : height; size > 1; size /= 2) count++;
    return count;
}

static bool make_texture(struct scene_gpu *s, const char *name, enum gpu_format format, int width,
                         int height, const void *texels, gpu_image *out)
{
    struct gpu_image_desc desc = {
        .name = name,
        .dimension = GPU_2D,
        .format = format,
        .width = (uint32_t)width,
        .height = (uint32_t)height,
        .mips = mip_count(width, height),
        .usage = GPU_SAMPLED,
    };
    return gpu_image_create(s->gpu, &desc, out) &&
           gpu_image_upload(s->gpu, *out, 0, 0, texels,
                            (size_t)width * (size_t)height * (size_t)gpu_format_bytes(format)) &&
           (desc.mips == 1 || gpu_image_generate_mips(s->gpu, *out));
}

// A 16-bit float, 1/255 to 1; 0 for 0.
static uint16_t half_of_unorm8(uint32_t value)
{
    if (value == 0) return 0;
    int exponent;
    float mantissa = frexpf((float)value / 255.0f, &exponent); // 0.5 to 1
    return (uint16_t)((exponent + 14) * 1024 + (int)lroundf((mantissa * 2.0f - 1.0f) * 1024.0f));
}

static bool make_normals(struct scene_gpu *s, const char *name, const struct scene_image *image,
                         gpu_image *out)
{
    size_t count = 4 * (size_t)image->width * (size_t)image->height;
    uint16_t *texels = host_alloc(s->host, count, sizeof *texels), table[256];
    if (!texels) return false;
    for (uint32_t i = 0; i < 256; i++) table[i] = half_of_unorm8(i);
    for (size_t i = 0; i < count; i++) texels[i] = table[image->rgba[i]];
    bool ok = make_texture(s, name, GPU_RGBA16F, image->width, image->height, texels, out);
    host_free(s->host, texels);
    return ok;
}

static bool is_srgb(const struct scene_gpu *s, int map, int index)
{
    return is_color(map) && !s->scene->images[index].linear;
}

static gpu_image *texture_of(const struct scene_gpu *s, int map, int index)
{
    if (map == SCENE_MAP_NORMAL) return &s->normal_textures[index];
    return is_srgb(s, map, index) ? &s->color_textures[index] : &s->data_textures[index];
}

static bool make_image(struct scene_gpu *s, int index, int map)
{
    gpu_image *out = texture_of(s, map, index);
    if (out->id) return true;
    const struct scene_image *image = &s->scene->images[index];
    char *name = host_sprintf(s->host, "scene.%s", image->name ? image->name : "texture");
    if (!name) return false;
    bool ok = map == SCENE_MAP_NORMAL
                  ? make_normals(s, name, image, out)
                  : make_texture(s, name, is_srgb(s, map, index) ? GPU_RGBA8_SRGB : GPU_RGBA8,
                                 image->width, image->height, image->rgba, out);
    host_free(s->host, name);
    return ok;
}

static enum gpu_wrap wrap_of(enum texture_wrap wrap)
{
    switch (wrap) {
    case WRAP_MIRROR:
        return GPU_MIRROR;
    case WRAP_CLAMP:
        return GPU_CLAMP;
    default:
        return GPU_REPEAT;
    }
}

static bool make_map(struct scene_gpu *s, const struct material *material, int map,
                     struct gpu_binding *out)
{
    static const char *const names[SCENE_MAP_COUNT] = {
        [SCENE_MAP_BASE_COLOR] = "base_color_map",
        [SCENE_MAP_METALLIC_ROUGHNESS] = "metallic_roughness_map",
        [SCENE_MAP_NORMAL] = "normal_map",
        [SCENE_MAP_EMISSIVE] = "emissive_map",
        [SCENE_MAP_SPECULAR] = "specular_map",
        [SCENE_MAP_SPECULAR_COLOR] = "specular_color_map",
    };
    const struct texture_use *use = use_of(material, map);
    enum gpu_filter filter = use->image >= 0 && use->nearest ? GPU_NEAREST : GPU_LINEAR;
    struct gpu_sampler_desc sampler = {
        .name = "scene.sampler",
        .filter = filter,
        .mip_filter = filter,
        .wrap_u = wrap_of(use->wrap_u),
        .wrap_v = wrap_of(use->wrap_v),
        .wrap_w = GPU_CLAMP,
    };
    *out = (struct gpu_binding){ .name = names[map] };
    if (!gpu_sampler_get(s->gpu, &sampler, &out->sampler)) return false;
    if (use->image < 0) {
        out->image = map == SCENE_MAP_NORMAL ? s->flat_normal : s->white;
        return true;
    }
    if (!make_image(s, use->image, map)) return false;
    out->image = *texture_of(s, map, use->image);
    return true;
}

static bool list_reads(struct scene_gpu *s)
{
    const size_t images = (size_t)s->image_count;
    host_free(s->host, s->reads);
    s->read_count = 0;
    s->reads = host_alloc(s->host, 3 * images + 2, sizeof *s->reads);
    if (!s->reads) return false;
    s->reads[s->read_count++] = (struct gpu_binding){ .name = "white", .image = s->white };
    s->reads[s->read_count++] = (struct gpu_binding){ .name = "flat", .image = s->flat_normal };
    for (size_t i = 0; i < images; i++) {
        const gpu_image all[3] = { s->color_textures[i], s->data_textures[i],
                                   s->normal_textures[i] };
        for (int k = 0; k < 3; k++) {
            if (!all[k].id) continue;
            s->reads[s->read_count++] = (struct gpu_binding){ .name = "texture", .image = all[k] };
        }
    }
    return true;
}

static bool grow(struct scene_gpu *s, gpu_image **textures)
{
    gpu_image *grown = host_alloc(s->host, (size_t)s->scene->image_count, sizeof *grown);
    if (!grown) return false;
    for (int i = 0; *textures && i < s->image_count; i++) grown[i] = (*textures)[i];
    host_free(s->host, *textures);
    *textures = grown;
    return true;
}

static bool make_maps(struct scene_gpu *s)
{
    const size_t materials = (size_t)s->scene->material_count;
    host_free(s->host, s->maps);
    s->maps = host_alloc(s->host, materials, sizeof *s->maps);
    for (size_t m = 0; s->maps && m < materials; m++)
        for (int map = 0; map < SCENE_MAP_COUNT; map++)
            if (!make_map(s, &s->scene->materials[m], map, &s->maps[m][map])) return false;
    return s->maps != NULL;
}

// Textures that exist stay.
bool scene_gpu_make_textures(struct scene_gpu *s)
{
    static const uint8_t white[4] = { 255, 255, 255, 255 }, flat[4] = { 128, 128, 255, 255 };
    if (!grow(s, &s->color_textures) || !grow(s, &s->data_textures) ||
        !grow(s, &s->normal_textures))
        return false;
    s->image_count = s->scene->image_count;
    return (s->white.id || make_texture(s, "scene.white", GPU_RGBA8, 1, 1, white, &s->white)) &&
           (s->flat_normal.id ||
            make_texture(s, "scene.flat_normal", GPU_RGBA8, 1, 1, flat, &s->flat_normal)) &&
           make_maps(s) && list_reads(s);
}

void scene_gpu_destroy_textures(struct scene_gpu *s)
{
    for (int i = 0; i < s->image_count; i++) {
        gpu_image_destroy(s->gpu, &s->color_textures[i]);
        gpu_image_destroy(s->gpu, &s->data_textures[i]);
        gpu_image_destroy(s->gpu, &s->normal_textures[i]);
    }
    gpu_image_destroy(s->gpu, &s->white);
    gpu_image_destroy(s->gpu, &s->flat_normal);
    host_free(s->host, s->color_textures);
    host_free(s->host, s->data_textures);
    host_free(s->host, s->normal_textures);
    host_free(s->host, s->maps);
    host_free(s->host, s->reads);
}
