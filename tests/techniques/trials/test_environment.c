// Techniques under an environment map: against a uniform sky, against the reference, dimmed and
// rotated with the scene. Each prints its figures.
#include "scene/environment_fixture.h"
#include "techniques/baked_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/trials/light_trial.h"
#include "techniques/trials/light_trial_scenes.h"

#include <stdlib.h>

// Small bakes; values of light maps are half floats.
#define RADIOSITY          "radiosity:texels=4096"
#define ORT                "ort:texels=1024,offsets=100,coordinates=charts"
#define ORT_ROOM           "ort:texels=4096,offsets=400,coordinates=charts"
#define ORT_DARK           "ort:texels=8192,offsets=400,coordinates=charts"
#define DICTIONARY(texels) TRIAL_DICTIONARY(texels, 16, 12)
#define MRT                "mrt" DICTIONARY(8)
#define DRT                "drt" DICTIONARY(8)

static const double PI = 3.14159265358979;

// ---- scenes, rotated about +y in quarters: +x to −z, as environments turn

static vec3s quarter(vec3s p, int turns)
{
    for (int i = 0; i < turns; i++) p = vec3_of(p.z, p.y, -p.x);
    return p;
}

static void add_box(struct frame_fixture *s, vec3s min, vec3s max, int turns, int material)
{
    const vec3s a = quarter(min, turns), b = quarter(max, turns);
    fixture_box(s, glms_vec3_minv(a, b), glms_vec3_maxv(a, b), false, material);
}

enum scene_kind { BOX, BOX_ON_FLOOR };

// A box over nothing, of which each point sees its hemisphere; a box on a floor.
static void build(struct frame_fixture *s, struct gpu *gpu, enum scene_kind kind, int turns)
{
    fixture_init(s, gpu);
    s->width = s->height = 24;
    const int material = fixture_matte(s, vec3_of(0.7f, 0.6f, 0.5f));
    add_box(s, vec3_of(-1, 0, -1), vec3_of(1, 2, 1), turns, material);
    if (kind == BOX_ON_FLOOR) {
        const vec3s a = quarter(vec3_of(-4, 0, 4), turns), b = quarter(vec3_of(4, 0, 4), turns);
        fixture_quad(s, a, b, glms_vec3_scale(a, -1), glms_vec3_scale(b, -1), material);
    }
    fixture_look(s, quarter(vec3_of(3, 4, 4), turns), vec3_of(0, 0.8f, 0));
    if (kind == BOX) s->input.camera.vertical_fov_rad = 0.6f;
}

struct image_of {
    float *irradiance, *depth;
    size_t pixels;
};

static struct image_of render(struct frame_fixture *s, const char *text)
{
    struct image_of image = { .pixels = (size_t)s->width * s->height };
    fixture_open(s);
    struct gi *gi = gi_fixture_light(s, text);
    fixture_render(s);
    image.irradiance = fixture_read(s, READ_IRRADIANCE);
    image.depth = fixture_read(s, READ_DEPTH);
    gi_destroy(gi);
    return image;
}

static struct image_of image_under(struct gpu *gpu, const char *gi, enum scene_kind kind, int turns,
                                   const struct environment *environment)
{
    struct frame_fixture s;
    build(&s, gpu, kind, turns);
    s.input.environment = *environment;
    const struct image_of image = render(&s, gi);
    fixture_finish(&s);
    return image;
}

static void image_free(struct image_of *image)
{
    free(image->irradiance);
    free(image->depth);
}

// Over pixels with a surface: by channel the mean of a, and of factor · b; the largest difference
// over the mean of its channel.
struct comparison {
    double mean[2][3], most;
};

static struct comparison compare(const struct image_of *a, const struct image_of *b, double factor)
{
    struct comparison c = { 0 };
    double most[3] = { 0 };
    int count = 0;
    for (size_t i = 0; i < a->pixels; i++) {
        if (!(a->depth[i] > 0) || !(b->depth[i] > 0)) continue;
        count++;
        for (size_t k = 0; k < 3; k++) {
            const double x = (double)a->irradiance[3 * i + k];
            const double y = factor * (double)b->irradiance[3 * i + k];
            c.mean[0][k] += x;
            c.mean[1][k] += y;
            most[k] = fmax(most[k], fabs(x - y));
        }
    }
    assert_true(count > 100);
    for (int k = 0; k < 3; k++) {
        c.mean[0][k] /= count;
        c.mean[1][k] /= count;
        c.most = fmax(c.most, most[k] / c.mean[1][k]);
    }
    return c;
}

static double mean_difference(const struct comparison *c)
{
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, fabs(c->mean[0][k] / c->mean[1][k] - 1));
    return most;
}

static vec3s uniform(vec3s d)
{
    (void)d;
    return vec3_of(3, 2, 1);
}

// Bands 0 and 1, of which 9 coefficients have all: red from +x, green from +y, blue from +z.
static vec3s gradient(vec3s d)
{
    return vec3_of(2 + 1.6f * d.x, 2 + 1.6f * d.y, 2 + 1.6f * d.z);
}

struct trial {
    const char *gi;
    double tolerance;
};
#define COUNT(cases) (sizeof(cases) / sizeof *(cases))

TEST_GPU(a_uniform_map_is_a_uniform_sky)
{
    static const struct trial cases[] = {
        { "vct:quality=high", 0.01 }, { "lpv", 0.01 },     { "holpv", 0.01 },
        { "ambient", 1e-3 },          { RADIOSITY, 2e-3 }, { ORT, 2e-3 }
    };
    const struct environment map = { .map = fixture_map(32, uniform), .strength = 1 };
    const struct environment sky = { .sky = uniform(vec3_of(0, 1, 0)) };
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct image_of a = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 0, &map);
        struct image_of b = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 0, &sky);
        const struct comparison c = compare(&a, &b, 1);
        print_message("%s: uniform map against sky: at most %.5f\n", cases[i].gi, c.most);
        CHECK(c.mean[0][0] > 1 && c.most <= cases[i].tolerance);
        image_free(&a);
        image_free(&b);
    }
    environment_map_release(map.map);
}

TEST_GPU(strength_is_a_factor_of_all_light)
{
    static const struct trial cases[] = {
        { "vct:quality=high", 0.01 }, { "lpv", 0.01 },     { "holpv", 0.01 },
        { "ambient", 1e-3 },          { RADIOSITY, 2e-3 }, { ORT, 2e-3 }
    };
    const struct environment once = { .map = fixture_map(32, gradient), .strength = 1 };
    struct environment thrice = once;
    thrice.strength = 3;
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct image_of a = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 0, &thrice);
        struct image_of b = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 0, &once);
        const struct comparison c = compare(&a, &b, 3);
        print_message("%s: strength 3 against thrice: at most %.5f\n", cases[i].gi, c.most);
        CHECK(c.mean[0][0] > 1 && c.most <= cases[i].tolerance);
        image_free(&a);
        image_free(&b);
    }
    environment_map_release(once.map);
}

TEST_GPU(rotating_everything_gives_the_same_light)
{
    static const struct trial cases[] = {
        { "vct:quality=high", 0.03 }, { "lpv", 0.01 },     { "holpv", 0.01 },
        { "ambient", 0.01 },          { RADIOSITY, 0.01 }, { ORT, 0.01 }
    };
    struct environment e = { .map = fixture_map(64, gradient), .strength = 1 };
    for (size_t i = 0; i < COUNT(cases); i++) {
        e.rotation_rad = 0.3f;
        struct image_of still = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 0, &e);
        e.rotation_rad += GLM_PI_2f;
        struct image_of rotated = image_under(gpu, cases[i].gi, BOX_ON_FLOOR, 1, &e);
        const struct comparison c = compare(&rotated, &still, 1);
        print_message("%s: rotated by a quarter: means by %.5f, pixels by at most %.4f\n",
                      cases[i].gi, mean_difference(&c), c.most);
        CHECK(mean_difference(&c) <= cases[i].tolerance);
        image_free(&rotated);
        image_free(&still);
    }
    environment_map_release(e.map);
}

// The same stack, after frames under the first environment.
static struct image_of image_after(struct gpu *gpu, const char *text,
                                   const struct environment *first,
                                   const struct environment *second)
{
    enum { BEFORE = 3, AFTER = 12 };
    struct frame_fixture s;
    build(&s, gpu, BOX_ON_FLOOR, 0);
    struct image_of image = { .pixels = (size_t)s.width * s.height };
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, text);
    for (int i = 0; i < BEFORE + AFTER; i++) {
        s.input.environment = i < BEFORE ? *first : *second;
        fixture_render(&s);
    }
    image.irradiance = fixture_read(&s, READ_IRRADIANCE);
    image.depth = fixture_read(&s, READ_DEPTH);
    gi_destroy(gi);
    fixture_finish(&s);
    return image;
}

// After a change of the environment against the same one all along.
static struct comparison after_change(struct gpu *gpu, const char *gi, bool turn)
{
    const struct environment first = { .map = fixture_map(32, gradient), .strength = 1 };
    struct environment second = first;
    if (turn)
        second.rotation_rad = GLM_PIf;
    else
        second.map = fixture_map(32, uniform);
    struct image_of got = image_after(gpu, gi, &first, &second);
    struct image_of alone = image_after(gpu, gi, &second, &second);
    const struct comparison c = compare(&got, &alone, 1);
    print_message("%s: after a change: means by %.4f, pixels by at most %.4f\n", gi,
                  mean_difference(&c), c.most);
    image_free(&got);
    image_free(&alone);
    if (!turn) environment_map_release(second.map);
    environment_map_release(first.map);
    return c;
}

// Light that is kept from frame to frame follows.
TEST_GPU(light_follows_an_environment_that_turns_or_is_replaced)
{
    static const struct trial cases[] = { { "vct:quality=high,temporal=false", 0.005 },
                                          { "vct:temporal=false", 0.005 },
                                          { "lpv", 0.005 },
                                          { "holpv", 0.005 },
                                          { "ambient", 0.002 },
                                          { RADIOSITY, 0.005 },
                                          { ORT, 0.005 },
                                          { MRT, 0.005 },
                                          { DRT, 0.005 } };
    for (size_t i = 0; i < COUNT(cases); i++)
        for (int turn = 0; turn < 2; turn++)
            CHECK(after_change(gpu, cases[i].gi, turn).most <= cases[i].tolerance);
}

// Pixels of both runs have rays of other frames, and noise; a rest of the first light would be in
// the mean.
TEST_GPU(accumulated_light_follows_an_environment)
{
    static const char *const cases[] = { "vct:quality=low", "vct", "vct:quality=high" };
    for (size_t i = 0; i < COUNT(cases); i++)
        for (int turn = 0; turn < 2; turn++) {
            const struct comparison c = after_change(gpu, cases[i], turn);
            CHECK(mean_difference(&c) <= 0.01);
        }
}

// ---- against the reference

static struct trial_irradiance expected_under(struct gpu *gpu, enum scene_kind kind,
                                              const struct environment *environment)
{
    struct frame_fixture s;
    build(&s, gpu, kind, 0);
    s.input.environment = *environment;
    const struct trial_irradiance expected = trial_reference(&s, -1, 64);
    fixture_finish(&s);
    return expected;
}

static void check_shares(struct gpu *gpu, enum scene_kind kind, const struct trial *cases,
                         size_t count)
{
    const struct environment e = { .map = fixture_map(64, gradient),
                                   .strength = 2,
                                   .rotation_rad = 0.5f };
    const struct trial_irradiance expected = expected_under(gpu, kind, &e);
    for (size_t i = 0; i < count; i++) {
        struct frame_fixture s;
        build(&s, gpu, kind, 0);
        s.input.environment = e;
        const struct trial_irradiance got = trial_technique(&s, cases[i].gi);
        fixture_finish(&s);
        print_message("%s: %.3f %.3f %.3f of the reference's %.2f %.2f %.2f lux\n", cases[i].gi,
                      got.mean[0] / expected.mean[0], got.mean[1] / expected.mean[1],
                      got.mean[2] / expected.mean[2], expected.mean[0], expected.mean[1],
                      expected.mean[2]);
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(got.mean[c], expected.mean[c], cases[i].tolerance);
    }
    environment_map_release(e.map);
}

TEST_GPU(a_convex_body_gets_the_light_of_the_map)
{
    static const struct trial cases[] = { { "vct:quality=high", 0.1 }, { "lpv", 0.25 },
                                          { "holpv", 0.25 },           { "ambient", 0.03 },
                                          { RADIOSITY, 0.1 },          { ORT, 0.1 } };
    check_shares(gpu, BOX, cases, COUNT(cases));
}

TEST_GPU(a_box_on_a_floor_gets_the_light_of_the_map)
{
    static const struct trial cases[] = { { "vct:quality=high", 0.1 },
                                          { "lpv", 0.25 },
                                          { "holpv", 0.25 },
                                          { RADIOSITY, 0.1 },
                                          { MRT, 0.15 },
                                          { DRT, 0.15 },
                                          { ORT, 0.1 } };
    check_shares(gpu, BOX_ON_FLOOR, cases, COUNT(cases));
}

// ---- objects that are lit by probes

// A movable box over a grey floor, which fills the image.
static void build_movable(struct frame_fixture *s, struct gpu *gpu,
                          const struct environment *environment)
{
    fixture_init(s, gpu);
    fixture_floor(s, 4, fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    trial_add_movable_box(s, vec3_of(0, 1, 0), 1, fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_look(s, vec3_of(3, 3, 4), vec3_of(0, 1, 0));
    s->input.camera.vertical_fov_rad = 0.2f;
    s->input.environment = *environment;
}

TEST_GPU(a_movable_box_gets_the_light_of_the_map_by_probes)
{
    static const struct trial cases[] = { { RADIOSITY, 0.15 }, { MRT, 0.15 }, { DRT, 0.15 } };
    const struct environment e = { .map = fixture_map(64, gradient),
                                   .strength = 2,
                                   .rotation_rad = 0.5f };
    struct frame_fixture s;
    build_movable(&s, gpu, &e);
    const struct trial_irradiance expected = trial_reference(&s, -1, 64);
    fixture_finish(&s);
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct baked_fixture run;
        build_movable(&s, gpu, &e);
        baked_fixture_open(&run, &s, cases[i].gi);
        const struct trial_irradiance got = trial_object_irradiance(&s, 1);
        baked_fixture_close(&run, &s);
        print_message("%s: movable box: %.3f %.3f %.3f of the reference's %.2f %.2f %.2f lux\n",
                      cases[i].gi, got.mean[0] / expected.mean[0], got.mean[1] / expected.mean[1],
                      got.mean[2] / expected.mean[2], expected.mean[0], expected.mean[1],
                      expected.mean[2]);
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(got.mean[c], expected.mean[c], cases[i].tolerance);
    }
    environment_map_release(e.map);
}

// ---- darkness

static double room_irradiance(struct gpu *gpu, const char *gi, bool dark,
                              const struct environment *environment)
{
    struct frame_fixture s;
    trial_two_rooms(&s, gpu, dark);
    s.input.light_count = 0;
    s.input.environment = *environment;
    const struct trial_irradiance e = trial_technique(&s, gi);
    fixture_finish(&s);
    return e.mean[1];
}

// Cones leak as in a room beside a sunlit one, no more than under a uniform sky. Texels of ort that
// reach through a wall have light of both sides, by their size and place (its README, "Limits");
// 8192 lie well.
TEST_GPU(a_closed_room_under_a_bright_map_stays_dark)
{
    static const struct trial cases[] = { { "vct:quality=high", 0.05 },
                                          { "lpv", 0.005 },
                                          { "holpv", 0.005 },
                                          { RADIOSITY, 0.005 },
                                          { ORT_DARK, 0.01 } };
    const struct environment e = { .map = fixture_map(64, gradient), .strength = 1000 };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const double open = room_irradiance(gpu, cases[i].gi, false, &e);
        const double dark = room_irradiance(gpu, cases[i].gi, true, &e);
        print_message("%s: closed room %.5f of the open one (%.0f lux)\n", cases[i].gi, dark / open,
                      open);
        CHECK(open > 0.1 * PI * 1000 && dark <= cases[i].tolerance * open);
    }
    environment_map_release(e.map);
}
