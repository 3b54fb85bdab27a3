// Prefiltered light: links that do not cross walls, steps between them, levels of offsets, and the
// levels of light on the GPU against the same sums on the CPU.
#include "techniques/trials/light_trial_scenes.h"
#include "techniques/ort/bake_fixture.h"

#include "core/half.h"
#include "core/rng.h"
#include "framework/gpu_test.h"
#include "technique_shaders.h"
#include "techniques/ort/levels.h"
#include "techniques/ort/ort_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- links

static bool is_in_dark_room(const struct ort_map *map, uint32_t texel)
{
    const vec3s at = glms_vec3_muladds(chart_texel_normal(&map->charts, texel), 0.01f,
                                       chart_texel_of(&map->charts, texel)->position);
    return at.x > 0.025f && at.x < 4 && at.y > 0 && at.y < 3 && fabsf(at.z) < 2;
}

struct link_count {
    uint32_t inside, across;
};

static void count_links(const struct ort_map *map, const uint8_t *links, struct link_count *out)
{
    for (uint32_t i = 0; i < map->texel_count; i++)
        for (int axis = 0; axis < 2; axis++) {
            const struct ort_place at = ort_place_of(map, i);
            if (!(links[i] & (axis ? ORT_LINK_Y : ORT_LINK_X))) continue;
            const uint32_t next = ort_texel_at(map, at, axis == 0, axis == 1);
            assert_true(next != CHART_NONE);
            const bool dark = is_in_dark_room(map, i);
            out->inside += dark;
            out->across += dark != is_in_dark_room(map, next);
        }
}

TEST(links_fill_a_dark_room_and_do_not_cross_its_walls)
{
    struct ort_fixture f = { 0 };
    struct link_count count = { 0 };
    trial_two_rooms(&f.s, NULL, true);
    ort_fixture_open(&f, "texels=4096,offsets=50");
    struct ort_baked baked = ort_fixture_bake(&f, "rays=16", 0);
    count_links(&f.map, tensors_find(baked.tensors, ORT_LINKS)->data, &count);
    print_message("%u links in the dark room, %u across its walls\n", count.inside, count.across);
    CHECK(count.inside > 1000 && count.across == 0);
    ort_baked_finish(&baked);
    ort_fixture_close(&f);
}

// ---- levels of offsets

// The highest level whose offsets all have a spacing, in a grid of them.
static uint8_t level_of_spacing(const struct ort_map *map, int32_t spacing)
{
    enum { MOST = 4096 };
    static int32_t offset[MOST][2];
    uint8_t level[MOST], most = 0;
    uint32_t count = 0;
    for (int32_t y = -(int32_t)map->height + 1; y < (int32_t)map->height; y += spacing)
        for (int32_t x = -(int32_t)map->width + 1; x < (int32_t)map->width; x += spacing) {
            assert_true(count < MOST);
            offset[count][0] = x;
            offset[count++][1] = y;
        }
    const struct ort_maps maps = { map, .offset = offset[0], .offsets = count, .count = count };
    CHECK(ort_find_levels(&maps, level));
    for (uint32_t k = 0; k < count; k++) most = level[k] > most ? level[k] : most;
    return most;
}

// Standard deviations are 0, 1, 3.2 and 9.5 texels; half the radius is 0.28 of the spacing.
TEST(level_of_an_offset_follows_the_size_of_its_region)
{
    struct ort_map map = { .host = test_host(), .width = 32, .height = 16 };
    CHECK(level_of_spacing(&map, 1) == 0);
    CHECK(level_of_spacing(&map, 3) == 1);
    map.width = map.height = 256;
    CHECK(level_of_spacing(&map, 11) == 2);
    CHECK(level_of_spacing(&map, 34) == 3);
    CHECK(level_of_spacing(&map, 100) == 3);
}

// ---- steps, and light on the GPU

enum { WIDTH = 70, HEIGHT = 45, PLACES = WIDTH * HEIGHT };

// A plane of which every place is a texel, most of them linked.
static void random_links(struct ort_map *map, uint8_t *links)
{
    struct rng rng = rng_for(3, 1, 4);
    for (uint32_t i = 0; i < PLACES; i++) {
        map->texel_at[i] = i;
        const bool right = i % WIDTH + 1 < WIDTH && rng_u32(&rng) % 40 > 0;
        const bool below = i + WIDTH < PLACES && rng_u32(&rng) % 40 > 0;
        links[i] = (uint8_t)((right ? ORT_LINK_X : 0) | (below ? ORT_LINK_Y : 0));
    }
}

static float half_of(const uint32_t *words, size_t pair, int c, int of_pair)
{
    return float_from_half((uint16_t)(words[4 * pair + (size_t)c] >> 16 * of_pair));
}

// Both texels of all pairs; beyond the plane is no light.
static double worst_difference(struct gpu *gpu, const struct ort *s, uint32_t level,
                               const float *expected)
{
    enum { COLUMNS = WIDTH + 2 * ORT_MARGIN };
    static uint32_t words[(size_t)4 * COLUMNS * HEIGHT];
    double worst = 0;
    CHECK(gpu_image_download(gpu, s->tables.light, 0, level, words, sizeof words));
    for (int column = 0; column < COLUMNS; column++)
        for (int y = 0; y < HEIGHT; y++)
            for (int k = 0; k < 6; k++) {
                const int x = column - ORT_MARGIN + k / 3;
                const bool inside = x >= 0 && x < WIDTH;
                const float e = inside ? expected[3 * (y * WIDTH + x) + k % 3] : 0;
                const float got = half_of(words, (size_t)(column * HEIGHT + y), k % 3, k / 3);
                worst = fmax(worst, fabs((double)(got - e)) / fmax((double)e, 1e-3));
            }
    return worst;
}

static void open_levels(struct ort *s, struct gpu *gpu, uint8_t *links, const uint16_t *light)
{
    static uint32_t steps[PLACES];
    *s = (struct ort){ .gpu = gpu, .levels = ORT_LEVELS };
    s->map = (struct ort_map){ .host = test_host(), .width = WIDTH, .height = HEIGHT };
    s->map.texel_at = host_alloc(test_host(), PLACES, sizeof *s->map.texel_at);
    assert_non_null(s->map.texel_at);
    random_links(&s->map, links);
    ort_find_steps(&s->map, links, steps);
    const struct gpu_image_desc first_order = {
        "test.first_order", GPU_2D, GPU_RGBA16F, WIDTH, HEIGHT, .usage = GPU_SAMPLED
    };
    const struct gpu_image_desc step = { "test.steps", GPU_2D, GPU_R32U,
                                         HEIGHT,       WIDTH,  .usage = GPU_STORAGE };
    const struct gpu_image_desc filtered = { "test.filtered", GPU_2D, GPU_RGBA16F,
                                             HEIGHT,          WIDTH,  .usage = GPU_STORAGE };
    const struct gpu_image_desc levels = {
        "test.light",           GPU_2D_ARRAY, GPU_RGBA32U,         HEIGHT,
        WIDTH + 2 * ORT_MARGIN, ORT_LEVELS,   .usage = GPU_STORAGE
    };
    CHECK(gpu_image_create(gpu, &first_order, &s->tables.first_order) &&
          gpu_image_create(gpu, &step, &s->tables.steps) &&
          gpu_image_create(gpu, &filtered, &s->tables.filtered) &&
          gpu_image_create(gpu, &levels, &s->tables.light));
    CHECK(gpu_image_upload(gpu, s->tables.steps, 0, 0, steps, sizeof steps));
    CHECK(gpu_image_upload(gpu, s->tables.first_order, 0, 0, light, 4 * PLACES * sizeof *light));
    s->pipelines.spread = test_gpu_compute(gpu, &shader_ort_spread_comp);
    s->pipelines.prefilter_x = test_gpu_compute(gpu, &shader_ort_prefilter_x_comp);
    s->pipelines.prefilter_y = test_gpu_compute(gpu, &shader_ort_prefilter_y_comp);
}

static void close_levels(struct ort *s)
{
    gpu_image *images[] = { &s->tables.first_order, &s->tables.steps, &s->tables.filtered,
                            &s->tables.light };
    gpu_pipeline *pipelines[] = { &s->pipelines.spread, &s->pipelines.prefilter_x,
                                  &s->pipelines.prefilter_y };
    for (size_t i = 0; i < 4; i++) gpu_image_destroy(s->gpu, images[i]);
    for (size_t i = 0; i < 3; i++) gpu_pipeline_destroy(s->gpu, pipelines[i]);
    host_free(test_host(), s->map.texel_at);
}

// Small bright spots on a faint ground.
static void random_light(uint16_t *halves, float *light)
{
    struct rng rng = rng_for(5, 9, 2);
    for (int i = 0; i < PLACES; i++)
        for (int c = 0; c < 3; c++) {
            const float value = rng_u32(&rng) % 20 ? rng_float(&rng) : 1000 * rng_float(&rng);
            halves[4 * i + c] = half_from_float(value);
            light[3 * i + c] = float_from_half(halves[4 * i + c]);
        }
}

// Sums of floats in another order may round to the next half float, at each of six passes.
TEST_GPU(levels_of_light_are_the_sums_over_linked_texels)
{
    static uint8_t links[PLACES];
    static uint16_t halves[4 * PLACES];
    static float light[3 * PLACES], rows[3 * PLACES];
    struct ort s;
    random_light(halves, light);
    open_levels(&s, gpu, links, halves);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    ort_record_levels(&s, cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    for (int level = 0, stride = 1; level < ORT_LEVELS; level++) {
        const double worst = worst_difference(gpu, &s, (uint32_t)level, light);
        print_message("level %d: relative difference %.2g\n", level, worst);
        CHECK(worst <= 2 * level * 0x1p-10);
        ort_filter_light(&s.map, links, 0, stride, light, rows);
        ort_filter_light(&s.map, links, 1, stride, rows, light);
        stride *= 3;
    }
    close_levels(&s);
}
