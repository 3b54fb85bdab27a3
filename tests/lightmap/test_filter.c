// The filter of light by paths: noise falls, means and edges stay.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/filter.h"
#include "lightmap/gather.h"

#include <math.h>
#include <string.h>

static const int TEXELS = 4096;

struct maps {
    struct scene *scene;
    struct scene_pose pose;
    struct charts charts;
    size_t count; // floats
};

static void open_scene(struct maps *m, const char *name)
{
    *m = (struct maps){ .scene = scene_load(test_host(), name) };
    assert_non_null(m->scene);
    CHECK(pose_init(&m->pose, m->scene, -1, 0));
    CHECK(fixture_charts(&m->pose, &TEXELS, test_host(), NULL, &m->charts));
    m->count = (size_t)m->charts.side_texel_count * LIGHTMAP_COLUMNS;
}

static void close_scene(struct maps *m)
{
    charts_finish(&m->charts);
    pose_finish(&m->pose);
    scene_destroy(m->scene);
}

// A copy of the rows. Owned by the caller.
static float *bake(const struct maps *m, int samples, uint64_t seed)
{
    struct bake *bake = fixture_bake(&(struct fixture_bake){
        .pose = &m->pose, .texels = TEXELS, .samples = samples, .seed = seed });
    float *light = host_alloc(test_host(), m->count, sizeof *light);
    assert_non_null(light);
    memcpy(light, fixture_tensor(bake, LIGHTMAP_REST), m->count * sizeof *light);
    bake_destroy(bake);
    return light;
}

// Mean squared difference over the squared mean.
static double error_of(const struct maps *m, const float *light, const float *reference)
{
    double squares = 0.0, sum = 0.0;
    for (size_t i = 0; i < m->charts.side_texel_count; i++) {
        const double a = fixture_luminance(light, i), b = fixture_luminance(reference, i);
        squares += (a - b) * (a - b);
        sum += b;
    }
    return squares * m->charts.side_texel_count / (sum * sum);
}

static double mean_of(const struct maps *m, const float *light)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->charts.side_texel_count; i++) sum += fixture_luminance(light, i);
    return sum / m->charts.side_texel_count;
}

// Texels whose paths are not shared.
static float *bake_alone(const struct maps *m, int samples, uint64_t seed)
{
    struct gather_scene scene;
    float *light = host_alloc(test_host(), m->count, sizeof *light);
    assert_non_null(light);
    CHECK(gather_scene_init(&scene, test_host(), &m->pose, &m->charts));
    for (uint32_t i = 0; i < m->charts.side_texel_count; i++) {
        struct gather_points points;
        gather_find_points(&scene, i, &points);
        const vec3s value = gather_paths(&scene, &points, samples, seed);
        memcpy(light + LIGHTMAP_COLUMNS * (size_t)i, value.raw, sizeof value.raw);
    }
    gather_scene_finish(&scene);
    return light;
}

// Shared paths have a share of that error, which the filter lowers once more.
TEST(filter_takes_two_thirds_of_the_error_of_paths_and_keeps_the_mean)
{
    struct maps m;
    open_scene(&m, "@cornell");
    float *reference = bake(&m, 1024, 2), *noisy = bake(&m, 32, 1), *alone = bake_alone(&m, 32, 1),
          *smooth = host_alloc(test_host(), m.count, sizeof *smooth);
    CHECK(smooth && lightmap_filter(&m.charts, noisy, smooth));
    const double before = error_of(&m, alone, reference), after = error_of(&m, smooth, reference);
    const double shared = error_of(&m, noisy, reference);
    print_message("error %.5f, shared %.5f, filtered %.5f; mean %.4f of the noisy one\n", before,
                  shared, after, mean_of(&m, smooth) / mean_of(&m, noisy));
    CHECK(shared < 0.34 * before);
    CHECK(after < 0.2 * before);
    CHECK(after < 0.7 * shared);
    host_free(test_host(), alone);
    CHECK_RELATIVE(mean_of(&m, smooth), mean_of(&m, noisy), 0.01);
    host_free(test_host(), reference);
    host_free(test_host(), noisy);
    host_free(test_host(), smooth);
    close_scene(&m);
}

TEST(variance_of_texels_is_that_of_bakes_with_other_seeds)
{
    struct maps m;
    open_scene(&m, "@cornell");
    float *a = bake(&m, 64, 1), *b = bake(&m, 64, 2);
    double stated = 0.0, measured = 0.0;
    for (size_t i = 0; i < m.charts.side_texel_count; i++) {
        const double difference = fixture_luminance(a, i) - fixture_luminance(b, i);
        stated += (double)a[LIGHTMAP_COLUMNS * i + LIGHTMAP_VARIANCE];
        measured += 0.5 * difference * difference;
    }
    print_message("variance stated over measured %.3f\n", stated / measured);
    CHECK(stated > 0.9 * measured && stated < 2.0 * measured);
    host_free(test_host(), a);
    host_free(test_host(), b);
    close_scene(&m);
}

TEST(light_without_variance_stays_with_its_edges)
{
    struct maps m;
    open_scene(&m, "@cornell");
    float *light = bake(&m, 1, 1);
    for (size_t i = 0; i < m.charts.side_texel_count; i++) {
        float *row = light + LIGHTMAP_COLUMNS * i;
        for (int c = 0; c < 3; c++) row[c] = i % 3 == 0 ? 100.0f : 1.0f;
        row[LIGHTMAP_VARIANCE] = 0.0f;
    }
    float *out = host_alloc(test_host(), m.count, sizeof *out);
    CHECK(out && lightmap_filter(&m.charts, light, out));
    for (size_t i = 0; i < m.charts.side_texel_count; i++)
        if (out[LIGHTMAP_COLUMNS * i + LIGHTMAP_SHARE] > 0.0f)
            CHECK_RELATIVE(out[LIGHTMAP_COLUMNS * i], i % 3 == 0 ? 100.0 : 1.0, 1e-4);
    host_free(test_host(), light);
    host_free(test_host(), out);
    close_scene(&m);
}
