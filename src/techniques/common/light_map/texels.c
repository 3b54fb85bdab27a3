#include "techniques/common/light_map/texels.h"

#include "bake/tensors.h"
#include "scene/environment.h"
#include "techniques/common/light_map/tensors.h"

#include <string.h>

bool light_map_find_texels(struct light_map_texels *out, struct host *host,
                           const struct charts *charts, const struct tensors *bake)
{
    const uint64_t n = light_map_rows(charts->side_texel_count);
    *out = (struct light_map_texels){ .charts = charts };
#define EXPECT(...) TENSORS_EXPECT(host, bake, __VA_ARGS__)
    return (out->sky = EXPECT(LIGHT_MAP_SKY, TENSOR_F32, n, 4)) &&
           (out->point = EXPECT(LIGHT_MAP_POINT, TENSOR_F32, n, 4));
#undef EXPECT
}

float light_map_texel_area(const struct light_map_texels *t, uint32_t texel)
{
    return t->point[4 * (size_t)texel + 3] * chart_texel_of(t->charts, texel)->area_m2;
}

uint32_t *light_map_nearest_valid(const struct light_map_texels *t, struct host *host)
{
    const uint32_t count = t->charts->side_texel_count;
    bool *hidden = host_alloc(host, count, sizeof *hidden);
    for (uint32_t i = 0; hidden && i < count; i++)
        hidden[i] = !(t->point[4 * (size_t)i + 3] > 0.0f);
    uint32_t *nearest_valid = hidden ? charts_fill(t->charts, hidden) : NULL;
    host_free(host, hidden);
    return nearest_valid;
}

// The mean shading normal, of length 1 or less.
static vec3s mean_shading(const struct light_map_texels *t, uint32_t i)
{
    const float *shading = t->shading ? t->shading + 3 * (size_t)i : NULL;
    if (shading) return vec3_of(shading[0], shading[1], shading[2]);
    return glms_vec3_scale(chart_texel_normal(t->charts, i), t->reflectance[4 * (size_t)i + 3]);
}

static void fill_texel(const struct light_map_texels *t, uint32_t i, vec4s *parts)
{
    const size_t count = t->charts->side_texel_count;
    const float *point = t->point + 4 * (size_t)i, *reflectance = t->reflectance + 4 * (size_t)i;
    parts[TEXEL_POSITION * count + i] =
        vec4_of(vec3_of(point[0], point[1], point[2]), light_map_texel_area(t, i));
    parts[TEXEL_NORMAL * count + i] =
        vec4_of(chart_texel_normal(t->charts, i), t->roughness ? t->roughness[i] : 0.0f);
    parts[TEXEL_SHADING * count + i] = vec4_of(mean_shading(t, i), 0.0f);
    parts[TEXEL_REFLECTANCE * count + i] =
        vec4_of(vec3_of(reflectance[0], reflectance[1], reflectance[2]), 0.0f);
    memcpy(&parts[TEXEL_SKY_LIGHT * count + i], t->sky + 4 * (size_t)i, sizeof *parts);
    if (t->fluence && t->sky[4 * (size_t)i] > 0.0f)
        parts[TEXEL_FLUENCE * count + i].w = t->fluence[i] / t->sky[4 * (size_t)i];
    for (size_t k = 0; t->emitted && k < 3; k++)
        memcpy(&parts[(TEXEL_EMITTED_0 + k) * count + i], t->emitted + 12 * (size_t)i + 4 * k,
               sizeof *parts);
}

bool light_map_upload_texels(const struct light_map_texels *t, struct host *host, struct gpu *gpu,
                             gpu_image *out)
{
    const size_t count = (size_t)t->charts->side_texel_count * TEXEL_PARTS;
    vec4s *parts = host_alloc(host, light_map_table_capacity(count), sizeof *parts);
    for (uint32_t i = 0; parts && i < t->charts->side_texel_count; i++) fill_texel(t, i, parts);
    return light_map_table_upload(host, gpu, "texels", GPU_RGBA32F, parts, count, out);
}

bool light_map_upload_sky(const struct light_map_texels *t, struct host *host, struct gpu *gpu,
                          const struct tensors *bake, gpu_image *out)
{
    const size_t count = t->charts->side_texel_count, words = TEXEL_SKY_WORDS * count;
    const uint8_t *shares =
        TENSORS_EXPECT(host, bake, LIGHT_MAP_SKY_SHARES, TENSOR_U8,
                       light_map_rows(t->charts->side_texel_count), ENVIRONMENT_PATCHES);
    uint8_t(*table)[16] =
        shares ? host_alloc(host, light_map_table_capacity(words), sizeof *table) : NULL;
    for (size_t i = 0; table && i < count; i++)
        for (size_t k = 0; k < TEXEL_SKY_WORDS; k++)
            memcpy(table[k * count + i], shares + ENVIRONMENT_PATCHES * i + 16 * k, 16);
    return table && light_map_table_upload(host, gpu, "sky", GPU_RGBA32U, table, words, out);
}
