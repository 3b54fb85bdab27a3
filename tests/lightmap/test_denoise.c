// Denoising of light maps, chart by chart, with a stand-in for the denoiser.
#include "framework/test.h"

#include "lightmap/denoise.h"
#include "lightmap/denoiser/denoiser.h"

#include <math.h>
#include <string.h>

struct mapped {
    struct scene *scene;
    struct scene_pose pose;
    struct lightmap map;
};

// Each texel's light is that of `light` at its place in the atlas; unused texels are NaN.
static void open_map(struct mapped *m, float (*light)(uint32_t chart, uint32_t x, uint32_t y))
{
    *m = (struct mapped){ .scene = scene_load(test_host(), "@cornell") };
    assert_non_null(m->scene);
    CHECK(pose_init(&m->pose, m->scene, -1, 0));
    struct charts charts;
    CHECK(charts_init(&charts, test_host(), &m->pose,
                      &(struct charts_options){
                          .texels_per_m = 1e3f, .max_texels = 1 << 16, .surface_texels = 2048 }));
    CHECK(lightmap_init(&m->map, &charts, m->scene));
    const struct charts *c = &m->map.charts;
    for (uint32_t y = 0; y < c->height; y++)
        for (uint32_t x = 0; x < c->width; x++) {
            const uint32_t texel = c->owner[(size_t)y * c->width + x];
            float *at = image_at(&m->map.irradiance[0], (int)x, (int)y);
            for (int k = 0; k < 3; k++)
                at[k] = texel == CHART_NONE
                            ? NAN
                            : light(c->triangles[c->texels[texel].triangle].chart, x, y);
        }
    test_denoiser = (struct test_denoiser_state){ .buffers_left = -1 };
}

static void close_map(struct mapped *m)
{
    lightmap_finish(&m->map);
    pose_finish(&m->pose);
    scene_destroy(m->scene);
    assert_int_equal(test_denoiser.live, 0);
}

// The largest difference of a used texel from `light`, and whether unused ones are still NaN.
static float largest_difference(const struct mapped *m,
                                float (*light)(uint32_t chart, uint32_t x, uint32_t y))
{
    const struct charts *c = &m->map.charts;
    float most = 0.0f;
    for (uint32_t y = 0; y < c->height; y++)
        for (uint32_t x = 0; x < c->width; x++) {
            const uint32_t texel = c->owner[(size_t)y * c->width + x];
            const float *at = image_at(&m->map.irradiance[0], (int)x, (int)y);
            if (texel == CHART_NONE) {
                CHECK(isnan(at[0]));
                continue;
            }
            const uint32_t chart = c->triangles[c->texels[texel].triangle].chart;
            for (int k = 0; k < 3; k++) {
                CHECK(isfinite(at[k]));
                most = fmaxf(most, fabsf(at[k] - light(chart, x, y)));
            }
        }
    return most;
}

static float light_of_chart(uint32_t chart, uint32_t x, uint32_t y)
{
    (void)x, (void)y;
    return chart % 2 == 0 ? 0.0f : 1e4f + (float)chart;
}

TEST(denoising_brings_no_light_from_one_chart_to_another)
{
    struct mapped m;
    open_map(&m, light_of_chart);
    CHECK(lightmap_denoise(&m.map));
    assert_int_equal(test_denoiser.images, (m.map.has_back ? 2 : 1) * (int)m.map.charts.count);
    const float most = largest_difference(&m, light_of_chart);
    print_message("a chart's light changes by at most %g of 1e4\n", (double)most);
    CHECK(most <= 0.01f); // sums of 25 values of 1e4
    close_map(&m);
}

static float checker(uint32_t chart, uint32_t x, uint32_t y)
{
    (void)chart;
    return (x + y) % 2 == 0 ? 0.0f : 2.0f;
}

TEST(denoised_light_replaces_that_of_the_map)
{
    struct mapped m;
    open_map(&m, checker);
    CHECK(lightmap_denoise(&m.map));
    const struct charts *c = &m.map.charts;
    const struct chart *largest = c->charts;
    for (uint32_t i = 1; i < c->count; i++)
        if (c->charts[i].texel_count > largest->texel_count) largest = &c->charts[i];
    const uint32_t x = largest->x + largest->width / 2, y = largest->y + largest->height / 2;
    const float *at = image_at(&m.map.irradiance[0], (int)x, (int)y);
    CHECK_NEAR(at[0], checker(0, x, y) == 0.0f ? 24.0f / 25.0f : 26.0f / 25.0f, 1e-5);
    close_map(&m);
}

TEST(a_denoiser_without_memory_is_an_error)
{
    struct mapped m;
    open_map(&m, light_of_chart);
    test_denoiser.buffers_left = 1;
    CHECK(!lightmap_denoise(&m.map));
    CHECK(strstr(test_last_message(), "out of memory"));
    CHECK(largest_difference(&m, light_of_chart) <= 0.01f);
    close_map(&m);
}
