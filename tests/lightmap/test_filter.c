// The filter of light by paths: noise falls, means and edges stay.
#include "framework/test.h"

#include "lightmap/filter.h"

#include <math.h>
#include <string.h>

static bool make_charts(const struct scene_pose *statics, const void *options, struct host *host,
                        struct charts *out)
{
    (void)options;
    return charts_init(out, host, statics,
                       &(struct charts_options){
                           .texels_per_m = 1e3f, .max_texels = 1 << 18, .surface_texels = 4096 });
}

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
    CHECK(make_charts(&m->pose, NULL, test_host(), &m->charts));
    m->count = (size_t)m->charts.side_texel_count * LIGHTMAP_COLUMNS;
}

static void close_scene(struct maps *m)
{
    charts_finish(&m->charts);
    pose_finish(&m->pose);
    scene_destroy(m->scene);
}

static float *bake(const struct maps *m, int samples, uint64_t seed)
{
    const struct bake_identity identity = {
        .technique = LIGHTMAP_NAME, .version = 1, .options = "", .program = "test", .seed = seed
    };
    const struct lightmap_bake how = { .pose = &m->pose,
                                       .samples = samples,
                                       .charts = make_charts };
    struct bake *bake = bake_create(test_host(), &identity);
    CHECK(bake && lightmap_add_stages(bake_plan_of(bake), &how));
    CHECK(bake_run(bake, &(struct bake_run_options){ .threads = 0 }));
    const struct tensor *rest = tensors_find(bake_tensors(bake), LIGHTMAP_REST);
    float *light = host_alloc(test_host(), m->count, sizeof *light);
    assert_non_null(light);
    assert_int_equal(rest->bytes, m->count * sizeof *light);
    memcpy(light, rest->data, rest->bytes);
    bake_destroy(bake);
    return light;
}

static double luminance_at(const float *light, size_t texel)
{
    const float *row = light + LIGHTMAP_COLUMNS * texel;
    return (double)luminance(vec3_of(row[0], row[1], row[2]));
}

// Mean squared difference over the squared mean.
static double error_of(const struct maps *m, const float *light, const float *reference)
{
    double squares = 0.0, sum = 0.0;
    for (size_t i = 0; i < m->charts.side_texel_count; i++) {
        const double a = luminance_at(light, i), b = luminance_at(reference, i);
        squares += (a - b) * (a - b);
        sum += b;
    }
    return squares * m->charts.side_texel_count / (sum * sum);
}

static double mean_of(const struct maps *m, const float *light)
{
    double sum = 0.0;
    for (size_t i = 0; i < m->charts.side_texel_count; i++) sum += luminance_at(light, i);
    return sum / m->charts.side_texel_count;
}

TEST(filter_takes_two_thirds_of_the_error_of_paths_and_keeps_the_mean)
{
    struct maps m;
    open_scene(&m, "@cornell");
    float *reference = bake(&m, 1024, 2), *noisy = bake(&m, 32, 1), *smooth = bake(&m, 32, 1);
    CHECK(lightmap_filter(&m.charts, smooth));
    const double before = error_of(&m, noisy, reference), after = error_of(&m, smooth, reference);
    print_message("error %.5f, filtered %.5f; mean %.4f of the noisy one\n", before, after,
                  mean_of(&m, smooth) / mean_of(&m, noisy));
    CHECK(after < 0.34 * before);
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
        const double difference = luminance_at(a, i) - luminance_at(b, i);
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
    CHECK(lightmap_filter(&m.charts, light));
    for (size_t i = 0; i < m.charts.side_texel_count; i++)
        if (light[LIGHTMAP_COLUMNS * i + LIGHTMAP_SHARE] > 0.0f)
            CHECK_RELATIVE(light[LIGHTMAP_COLUMNS * i], i % 3 == 0 ? 100.0 : 1.0, 1e-4);
    host_free(test_host(), light);
    close_scene(&m);
}
