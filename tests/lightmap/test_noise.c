// Light maps by paths until the noise of each chart is at a bound.
#include "lightmap/lightmap_fixture.h"

#include "lightmap/noise.h"

#include <math.h>
#include <string.h>

static const float BOUND = 0.03f;
enum { MOST = 4096 };
static const int TEXELS = 2048;

// ---- units and estimates

TEST(units_are_all_texels_in_order_and_small_charts_are_joined)
{
    struct scene *scene = scene_load(test_host(), "@cornell");
    struct scene_pose pose;
    struct charts charts;
    struct noise_units units;
    CHECK(pose_init(&pose, scene, -1, 0));
    CHECK(charts_init(&charts, test_host(), &pose,
                      &(struct charts_options){ .texels_per_m = 3, .max_texels = 1 << 18 }));
    CHECK(noise_units_init(&units, &charts));
    uint32_t next = 0, small = 0;
    for (uint32_t u = 0; u < units.count; u++) {
        assert_int_equal(units.at[u].first, next);
        CHECK(units.at[u].count > 0);
        assert_int_equal(noise_unit_of(&units, next), u);
        next += units.at[u].count;
        assert_int_equal(noise_unit_of(&units, next - 1), u);
    }
    assert_int_equal(next, charts.side_texel_count);
    // Small units are followed by another instance, or by a chart that is enough alone.
    for (uint32_t u = 0; u + 1 < units.count; u++) {
        const struct chart_triangle *last = chart_triangle_of(&charts, units.at[u + 1].first - 1),
                                    *first = chart_triangle_of(&charts, units.at[u + 1].first);
        const bool joined = units.at[u].tiles < 4 && units.at[u + 1].tiles < 4;
        if (joined && units.at[u + 1].first != charts.texel_count)
            CHECK(last->instance != first->instance);
    }
    for (uint32_t c = 0; c < charts.count; c++) small += charts.charts[c].texel_count < 32;
    CHECK(small > 0 && units.count < charts.count);
    noise_units_finish(&units, test_host());
    charts_finish(&charts);
    pose_finish(&pose);
    scene_destroy(scene);
}

TEST(noise_is_the_standard_error_over_the_mean_light)
{
    // Means of groups 8 and 12 in turn: the variance of their mean is 8 · 2² / (8 · 7).
    struct noise_sums sums[3] = { { .paths = 80 }, { .paths = 80 }, { .paths = 0 } };
    for (int g = 0; g < NOISE_GROUPS; g++) sums[0].group[g] = sums[1].group[g] = g % 2 ? 120 : 80;
    const struct noise_unit unit = { 0, 3, 1 };
    const struct noise_state found = noise_of(&unit, sums, 0.0f);
    CHECK_RELATIVE(found.noise, sqrt(4.0 / 7.0) / 10.0, 1e-5);
    CHECK_NEAR(found.paths, 80, 0);
    // A dark unit counts against the least light.
    CHECK_RELATIVE(noise_of(&unit, sums, 100.0f).noise, sqrt(4.0 / 7.0) / 100.0, 1e-5);
    const struct noise_units units = { (struct noise_unit[]){ { 0, 3, 1 } }, 1 };
    CHECK_RELATIVE(noise_mean_light(&units, sums), 10.0, 1e-6);
}

// Paths that all missed a small source of light state no noise. One tile needs more of them, some
// hundred tiles do not.
TEST(prior_adds_paths_to_units_of_few_tiles)
{
    struct noise_sums sums[4] = { 0 };
    struct noise_unit at[4];
    for (uint32_t u = 0; u < 4; u++) {
        at[u] = (struct noise_unit){ u, 1, 1 };
        sums[u].paths = 32;
        // Relative variance of a path: 0, and about 1, 4 and 16.
        const float step = u == 0 ? 0.0f : (float)(1 << (u - 1)) * sqrtf(7.0f / 8.0f) / sqrtf(4);
        for (int g = 0; g < NOISE_GROUPS; g++)
            sums[u].group[g] = 4.0f * (g % 2 ? 1.0f + step : 1.0f - step);
    }
    float scratch[4];
    const struct noise_units units = { at, 4 };
    const float typical = noise_typical(&units, sums, 0.0f, scratch);
    CHECK_RELATIVE(typical, 4.0, 0.01); // the median of those with noise
    const struct noise_state none = { .paths = 32 };
    const struct noise_unit one = { 0, 16, 1 }, many = { 0, 1600, 100 };
    CHECK_RELATIVE(noise_with_prior(&one, none, typical).noise, sqrt(4.0 / 32 / 8), 0.01);
    CHECK(noise_with_prior(&many, none, typical).noise < 0.02f);
    const struct noise_state like = { .paths = 32, .noise = sqrtf(typical / 32) };
    CHECK_RELATIVE(noise_with_prior(&one, like, typical).noise, like.noise, 1e-5);
    CHECK_NEAR(noise_with_prior(&one, (struct noise_state){ 0 }, typical).noise, 0, 0);
}

TEST(paths_grow_with_the_square_of_the_noise_up_to_the_most)
{
    const struct noise_state found = { .noise = 0.1f, .paths = 40 };
    assert_int_equal(noise_paths_for(found, 0.05f, 1000), 160);
    assert_int_equal(noise_paths_for(found, 0.05f, 104), 104);
    assert_int_equal(noise_paths_for(found, 0.05f, 100), 96);
    assert_int_equal(noise_paths_for(found, 0.2f, 1000), 40);
    assert_int_equal(noise_paths_for(found, 1e-9f, 4096), 4096);
    CHECK(noise_paths_for(found, 0.09f, 1000) % NOISE_GROUPS == 0);
}

// ---- bakes

struct baked {
    struct scene *scene;
    struct scene_pose pose;
    struct bake *bake[2]; // of two seeds
    struct charts charts;
    struct noise_units units;
};

static struct bake *bake_of(const struct scene_pose *pose, float noise, int samples, uint64_t seed,
                            int threads)
{
    return fixture_bake(&(struct fixture_bake){ .pose = pose,
                                                .texels = TEXELS,
                                                .samples = samples,
                                                .noise = noise,
                                                .seed = seed,
                                                .threads = threads });
}

static void open_scene(struct baked *b, const char *name, float noise, int samples)
{
    *b = (struct baked){ .scene = scene_load(test_host(), name) };
    assert_non_null(b->scene);
    CHECK(pose_init(&b->pose, b->scene, -1, 0));
    for (int i = 0; i < 2; i++) b->bake[i] = bake_of(&b->pose, noise, samples, (uint64_t)i + 1, 0);
    CHECK(fixture_charts(&b->pose, &TEXELS, test_host(), NULL, &b->charts));
    CHECK(noise_units_init(&b->units, &b->charts));
}

static void close_scene(struct baked *b)
{
    noise_units_finish(&b->units, test_host());
    charts_finish(&b->charts);
    for (int i = 0; i < 2; i++) bake_destroy(b->bake[i]);
    pose_finish(&b->pose);
    scene_destroy(b->scene);
}

// Half the mean squared difference of two maps over the squared mean.
static double measured_noise(const struct baked *b, const struct noise_unit *unit)
{
    const float *rest[2] = { fixture_tensor(b->bake[0], LIGHTMAP_REST),
                             fixture_tensor(b->bake[1], LIGHTMAP_REST) };
    double squares = 0.0, light = 0.0;
    uint32_t count = 0;
    for (uint32_t i = unit->first; i < unit->first + unit->count; i++) {
        if (!(rest[0][LIGHTMAP_COLUMNS * (size_t)i + 3] > 0.0f)) continue;
        const double a = fixture_luminance(rest[0], i), c = fixture_luminance(rest[1], i);
        squares += 0.5 * (a - c) * (a - c);
        light += 0.5 * (a + c);
        count++;
    }
    return count > 0 && light > 0.0 ? sqrt(squares / count) / (light / count) : 0.0;
}

TEST(noise_of_each_chart_is_at_the_bound)
{
    struct baked b;
    open_scene(&b, "@cornell", BOUND, MOST);
    const float *rows = fixture_tensor(b.bake[0], LIGHTMAP_NOISE);
    int large = 0;
    double least = 1.0, most = 0.0;
    for (uint32_t u = 0; u < b.units.count; u++) {
        const float *row = rows + 3 * u;
        CHECK_NEAR(row[2], b.units.at[u].count, 0);
        CHECK(row[0] <= 1.1f * BOUND || row[1] >= MOST);
        // Fewer texels say little by two maps; units with the first paths alone are below it.
        if (b.units.at[u].count < 64 || row[1] < 33.0f) continue;
        const double noise = measured_noise(&b, &b.units.at[u]) / (double)BOUND;
        least = fmin(least, noise);
        most = fmax(most, noise);
        CHECK(noise > 0.5 && noise < 1.25);
        large++;
    }
    print_message("%d charts, measured noise %.2f to %.2f of the bound\n", large, least, most);
    CHECK(large > 4);
    close_scene(&b);
}

TEST(mean_light_is_that_of_one_number_of_paths)
{
    struct baked b;
    open_scene(&b, "@cornell", BOUND, MOST);
    struct bake *same = bake_of(&b.pose, 0.0f, 256, 9, 0);
    const float *a = fixture_tensor(b.bake[0], LIGHTMAP_REST),
                *c = fixture_tensor(same, LIGHTMAP_REST);
    double sum[2] = { 0.0, 0.0 };
    for (uint32_t i = 0; i < b.charts.side_texel_count; i++) {
        CHECK(a[LIGHTMAP_COLUMNS * (size_t)i + 3] == c[LIGHTMAP_COLUMNS * (size_t)i + 3]);
        sum[0] += fixture_luminance(a, i);
        sum[1] += fixture_luminance(c, i);
    }
    CHECK_RELATIVE(sum[0], sum[1], 0.005);
    CHECK(memcmp(fixture_tensor(b.bake[0], LIGHTMAP_PUNCTUAL),
                 fixture_tensor(same, LIGHTMAP_PUNCTUAL),
                 3 * sizeof(float) * b.charts.side_texel_count) == 0);
    bake_destroy(same);
    close_scene(&b);
}

TEST(light_is_the_same_for_any_number_of_threads)
{
    struct baked b;
    open_scene(&b, "@cornell", BOUND, 256);
    struct bake *one = bake_of(&b.pose, BOUND, 256, 1, 1);
    const struct tensors *x = bake_tensors(one), *y = bake_tensors(b.bake[0]);
    assert_int_equal(x->count, 3);
    for (size_t i = 0; i < x->count; i++)
        CHECK(memcmp(x->at[i].data, y->at[i].data, x->at[i].bytes) == 0);
    bake_destroy(one);
    close_scene(&b);
}

TEST(paths_of_a_texel_end_at_the_most)
{
    struct baked b;
    struct lightmap map;
    struct lightmap_noise noise;
    open_scene(&b, "@cornell", 0.001f, 50);
    const float *rows = fixture_tensor(b.bake[0], LIGHTMAP_NOISE);
    for (uint32_t u = 0; u < b.units.count; u++) CHECK(rows[3 * u + 1] <= 50.0f);
    const int units = (int)b.units.count;
    struct charts charts;
    CHECK(fixture_charts(&b.pose, &TEXELS, test_host(), NULL, &charts));
    CHECK(lightmap_init(&map, &charts, b.scene));
    CHECK(lightmap_noise_read(&map, bake_tensors(b.bake[0]), 50, 0.001f, &noise));
    CHECK(noise.above > units / 2 && noise.above <= units);
    CHECK(noise.largest > 0.001f && noise.paths > 32.0f && noise.paths <= 50.0f);
    lightmap_finish(&map);
    close_scene(&b);
}
