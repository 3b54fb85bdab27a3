// Path guiding: distributions of directions, and references with it and without.
#include "trace/direction_tree.h"
#include "trace/trace_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { RECORDS = 400, SAMPLES = 1 << 16, SIDE = 8, FINE = 1 << DIRECTION_TREE_DEPTH };

// A bright spot and little light elsewhere.
static int fit_spot(struct direction_node nodes[DIRECTION_TREE_NODES])
{
    static struct direction_record records[RECORDS];
    struct rng rng = rng_for(1, 2, 3);
    for (int i = 0; i < RECORDS; i++) {
        vec2s u = rng_vec2(&rng);
        records[i] = (struct direction_record){ .at = u, .weight = 0.01f };
        if (i % 2) records[i].at = (vec2s){ { 0.6f + 0.1f * u.x, 0.2f + 0.1f * u.y } };
        if (i % 2) records[i].weight = 1.0f;
    }
    return direction_tree_fit(records, RECORDS, nodes);
}

TEST(samples_of_a_tree_have_its_density)
{
    static struct direction_node nodes[DIRECTION_TREE_NODES];
    int count = fit_spot(nodes);
    CHECK(count > 1 && count <= DIRECTION_TREE_NODES);
    CHECK(direction_tree_density(nodes, (vec2s){ { 0.65f, 0.25f } }) > 10.0f);
    double expected[SIDE * SIDE] = { 0 }, found[SIDE * SIDE] = { 0 };
    for (int i = 0; i < FINE * FINE; i++) { // the density is constant on the smallest squares
        int x = i % FINE, y = i / FINE;
        vec2s at = { { ((float)x + 0.5f) / FINE, ((float)y + 0.5f) / FINE } };
        expected[x * SIDE / FINE + SIDE * (y * SIDE / FINE)] +=
            (double)direction_tree_density(nodes, at) / (FINE * FINE);
    }
    struct rng rng = rng_for(4, 5, 6);
    for (int i = 0; i < SAMPLES; i++) {
        vec2s sample = direction_tree_sample(nodes, rng_vec2(&rng));
        CHECK(sample.x >= 0 && sample.x <= 1 && sample.y >= 0 && sample.y <= 1);
        found[(int)(sample.x * SIDE) + SIDE * (int)(sample.y * SIDE)] += 1.0 / SAMPLES;
    }
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        CHECK_NEAR(found[i], expected[i], 0.008); // 4 standard errors of a share of 1/2
        sum += expected[i];
    }
    CHECK_RELATIVE(sum, 1, 1e-5);
}

TEST(directions_map_to_the_square_and_back)
{
    struct rng rng = rng_for(7, 8, 9);
    for (int axis = 0; axis < 6; axis++) {
        double sr = 0;
        for (int i = 0; i < 1 << 12; i++) {
            struct direction_point p;
            vec2s at = rng_vec2(&rng);
            vec3s d = direction_from_square(axis, at);
            CHECK_NEAR(glms_vec3_norm(d), 1, 1e-5);
            if (!direction_to_square(axis, d, &p)) continue; // on the horizon
            CHECK_NEAR(p.at.x, at.x, 1e-5);
            CHECK_NEAR(p.at.y, at.y, 1e-5);
            sr += (double)p.sr / (1 << 12);
        }
        CHECK_RELATIVE(sr, 6.283185307, 0.02);
    }
}

// A room with a window of a fiftieth of its walls, under the sky; with a sun if sun is above 0.
static void init_room(struct trace_fixture *s, float sun)
{
    fixture_init(s);
    s->width = s->height = 160;
    s->scene->environment.sky = vec3_of(3, 4, 5);
    int white = fixture_diffuse(s, vec3_of(0.7f, 0.6f, 0.5f), vec3_of(0, 0, 0));
    static const float C[][4][3] = {
        // floor, ceiling, back, front, right; then the left wall around the window
        { { -1, -1, 1 }, { 1, -1, 1 }, { 1, -1, -1 }, { -1, -1, -1 } },
        { { -1, 1, -1 }, { 1, 1, -1 }, { 1, 1, 1 }, { -1, 1, 1 } },
        { { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 }, { -1, 1, -1 } },
        { { 1, -1, 1 }, { -1, -1, 1 }, { -1, 1, 1 }, { 1, 1, 1 } },
        { { 1, -1, -1 }, { 1, -1, 1 }, { 1, 1, 1 }, { 1, 1, -1 } },
        { { -1, -1, 1 }, { -1, -1, -1 }, { -1, 0, -1 }, { -1, 0, 1 } },
        { { -1, 0.7f, 1 }, { -1, 0.7f, -1 }, { -1, 1, -1 }, { -1, 1, 1 } },
        { { -1, 0, 1 }, { -1, 0, 0.35f }, { -1, 0.7f, 0.35f }, { -1, 0.7f, 1 } },
        { { -1, 0, -0.35f }, { -1, 0, -1 }, { -1, 0.7f, -1 }, { -1, 0.7f, -0.35f } },
    };
    for (size_t i = 0; i < sizeof C / sizeof C[0]; i++) {
        vec3s p[4];
        for (int k = 0; k < 4; k++) p[k] = vec3_of(C[i][k][0], C[i][k][1], C[i][k][2]);
        fixture_quad(s, p[0], p[1], p[2], p[3], white);
    }
    if (sun > 0)
        fixture_light(s, LIGHT_SUN, vec3_of(0, 0, 0), vec3_of(0.8f, -0.5f, 0.3f),
                      vec3_of(sun, sun, sun));
    fixture_aim_camera(s, vec3_of(-0.8f, 0.1f, 0.8f), vec3_of(1, -0.4f, -1), 1.2f);
}

struct run {
    double mean, error, variance; // of the mean luminance over the image; per pixel and sample
    double rays;                  // per pixel and sample
};

// 24 samples per pixel.
static struct run run_room(float sun, int bounces, bool guiding, uint64_t seed)
{
    struct trace_fixture s;
    init_room(&s, sun);
    s.options.bounces = bounces;
    s.options.guiding = guiding;
    s.options.seed = seed;
    struct reference *r = fixture_reference(&s);
    assert_true(reference_render(r, 24, NULL, NULL));
    struct reference_info info = reference_info(r);
    double pixels = s.width * s.height;
    struct run run = { .mean = info.mean,
                       .error = info.error / sqrt(pixels),
                       .variance = info.error * info.error * 24,
                       .rays = (double)info.rays / pixels / 24 };
    reference_destroy(r);
    fixture_finish(&s);
    return run;
}

static struct run run_seeds(float sun, int bounces, bool guiding, uint64_t seed)
{
    enum { SEEDS = 3 };
    struct run all = { 0 };
    for (uint64_t i = 0; i < SEEDS; i++) {
        struct run run = run_room(sun, bounces, guiding, seed + i);
        all.mean += run.mean / SEEDS;
        all.rays += run.rays / SEEDS;
        all.variance += run.variance / SEEDS;
        all.error += run.error * run.error / (SEEDS * SEEDS);
    }
    all.error = sqrt(all.error);
    return all;
}

TEST(guiding_keeps_the_mean_of_a_room_with_a_window)
{
    for (int i = 0; i < 6; i++) {
        float sun = i % 2 ? 1000.0f : 0.0f;
        int bounces = i / 2 == 2 ? -1 : i / 2;
        struct run plain = run_seeds(sun, bounces, false, 1),
                   guided = run_seeds(sun, bounces, true, 9);
        CHECK(guided.variance < 0.9 * plain.variance); // it is guided
        double error = sqrt(plain.error * plain.error + guided.error * guided.error);
        print_message(
            "sun %g, bounces %d: mean %.4f and %.4f guided, error %.4f; variance %.3f and "
            "%.3f\n",
            (double)sun, bounces, plain.mean, guided.mean, error, plain.variance, guided.variance);
        CHECK_NEAR(guided.mean, plain.mean, 3.5 * error);
        CHECK(error < 0.03 * plain.mean);
    }
}

TEST(guiding_reduces_the_variance_of_a_room_with_a_window)
{
    for (int i = 0; i < 2; i++) {
        float sun = i ? 1000.0f : 0.0f;
        struct run plain = run_room(sun, -1, false, 3), guided = run_room(sun, -1, true, 3);
        CHECK(guided.variance < plain.variance / 2.5);
    }
}

static bool layers_are_equal(struct reference *a, struct reference *b, enum reference_layer layer)
{
    struct image x = { 0 }, y = { 0 };
    assert_true(reference_read(a, layer, &x) && reference_read(b, layer, &y));
    size_t bytes = (size_t)x.width * (size_t)x.height * (size_t)x.channels * sizeof *x.pixels;
    bool same = memcmp(x.pixels, y.pixels, bytes) == 0;
    image_finish(&x, test_host());
    image_finish(&y, test_host());
    return same;
}

TEST(guided_images_depend_neither_on_threads_nor_on_calls)
{
    struct trace_fixture s;
    init_room(&s, 40.0f);
    struct reference *one = fixture_reference(&s), *more = fixture_reference(&s);
    omp_set_num_threads(1);
    assert_true(reference_render(one, 12, NULL, NULL));
    omp_set_num_threads(4);
    assert_true(reference_render(more, 5, NULL, NULL));
    assert_true(reference_render(more, 7, NULL, NULL));
    CHECK(layers_are_equal(one, more, REFERENCE_COLOR));
    CHECK(layers_are_equal(one, more, REFERENCE_IRRADIANCE_EMITTERS_SKY));
    reference_destroy(one);
    reference_destroy(more);
    fixture_finish(&s);
}

TEST(guided_light_is_linear_to_the_bit)
{
    struct trace_fixture s;
    struct reference *r[2];
    struct image images[2];
    for (int i = 0; i < 2; i++) {
        init_room(&s, 40.0f * (float)(i + 1));
        s.scene->environment.sky = glms_vec3_scale(s.scene->environment.sky, (float)(i + 1));
        r[i] = fixture_reference(&s);
        assert_true(reference_render(r[i], 4, NULL, NULL));
        assert_true(reference_read(r[i], REFERENCE_COLOR, &images[i]));
        reference_destroy(r[i]);
        fixture_finish(&s);
    }
    for (size_t p = 0; p < 3u * 160 * 160; p++)
        CHECK(images[1].pixels[p] == 2.0f * images[0].pixels[p]);
    image_finish(&images[0], test_host());
    image_finish(&images[1], test_host());
}

static struct reference_info info_of(struct trace_fixture *s, bool guiding)
{
    s->options.guiding = guiding;
    struct reference *r = fixture_reference(s);
    assert_true(reference_render(r, 16, NULL, NULL));
    struct reference_info info = reference_info(r);
    reference_destroy(r);
    return info;
}

// Guiding would cost time and save nothing: the training alone is left.
TEST(an_open_plane_and_a_closed_box_are_not_guided)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell"); // neither sky nor punctual lights
    CHECK(info_of(&s, true).rays == info_of(&s, false).rays);
    fixture_finish(&s);
    fixture_init(&s);
    s.scene->environment.sky = vec3_of(1, 1, 1);
    fixture_quad(&s, vec3_of(-9, 0, 9), vec3_of(9, 0, 9), vec3_of(9, 0, -9), vec3_of(-9, 0, -9),
                 fixture_diffuse(&s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0)));
    fixture_aim_camera(&s, vec3_of(0, 1, 0), vec3_of(0.01f, 0, 0), 0.5f);
    struct reference_info plain = info_of(&s, false), guided = info_of(&s, true);
    CHECK(guided.mean == plain.mean);
    CHECK((double)guided.rays < 1.3 * (double)plain.rays);
    fixture_finish(&s);
}
