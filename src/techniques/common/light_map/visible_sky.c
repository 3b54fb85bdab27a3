#include "techniques/common/light_map/visible_sky.h"

#include "core/half.h"
#include "scene/charts/seams.h"
#include "techniques/common/light_map/surface.h"

// Adds the sky of a texel to `sum`, [4].
static void add(const float *sky, float weight, float *sum)
{
    for (int k = 0; k < 4; k++) sum[k] += weight / GLM_PIf * sky[k];
}

static void store(const float *sum, uint16_t *out)
{
    for (int k = 0; k < 4; k++) out[k] = half_from_float(sum[k]);
}

static void fill(const struct charts *charts, const struct chart_seams *seams,
                 const struct light_map_seam_rows *rows, const uint32_t *nearest_valid,
                 const float *sky, uint16_t *out)
{
    for (size_t i = 0; i < charts_place_count(charts); i++) {
        const uint32_t texel = chart_texel_of_place(charts, i);
        float sum[4] = { 0 };
        if (texel != CHART_NONE) add(sky + 4 * (size_t)nearest_valid[texel], 1.0f, sum);
        store(sum, out + 4 * i);
    }
    for (size_t i = 0; i < seams->count; i++) {
        float sum[4] = { 0 };
        for (size_t k = CHART_SEAM_ENTRIES * i; k < CHART_SEAM_ENTRIES * (i + 1); k++)
            add(sky + 4 * (size_t)nearest_valid[rows->texel[k]], rows->weight[k], sum);
        store(sum, out + 4 * (size_t)seams->places[i]);
    }
}

static bool upload(struct gpu *gpu, const struct charts *charts, const uint16_t *values,
                   gpu_image *out)
{
    struct gpu_image_desc desc = light_map_image(charts, "visible_sky", 1);
    const size_t values_of_side = 4 * (size_t)charts->width * charts->height;
    desc.depth = charts_sides(charts);
    desc.usage = GPU_SAMPLED;
    if (!gpu_image_create(gpu, &desc, out)) return false;
    for (uint32_t side = 0; side < desc.depth; side++)
        if (!gpu_image_upload(gpu, *out, 0, side, values + values_of_side * side,
                              values_of_side * sizeof *values))
            return false;
    return true;
}

bool light_map_upload_visible_sky(struct host *host, struct gpu *gpu, const struct charts *charts,
                                  const struct chart_seams *seams,
                                  const struct light_map_seam_rows *rows,
                                  const uint32_t *nearest_valid, const float *sky, gpu_image *out)
{
    uint16_t *values = host_alloc(host, charts_place_count(charts), 4 * sizeof *values);
    if (values) fill(charts, seams, rows, nearest_valid, sky, values);
    const bool ok = values && upload(gpu, charts, values, out);
    host_free(host, values);
    return ok;
}
