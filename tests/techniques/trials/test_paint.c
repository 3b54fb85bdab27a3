// Painted light: it is light as any other, of the texels that it was painted on, and leaves nothing
// behind.
#include "frame/frame_fixture.h"
#include "techniques/trials/paint_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const SPECS[] = { "ort:texels=1024,offsets=100",
                                     "radiosity:texels=2048,rays=100,sources=16" };
enum { SPEC_COUNT = sizeof SPECS / sizeof *SPECS };

static const vec3s LIT = { { 800, 500, 200 } };
// Half floats of first-order light, of texels, of the light map and of the image.
static const double ROUNDING = 4 * 0x1p-11;

struct painted {
    struct frame_fixture s;
    struct baked_fixture run;
    struct paint_fixture paint;
};

static void painted_open(struct painted *p, const char *spec)
{
    baked_fixture_open(&p->run, &p->s, spec);
    paint_fixture_open(&p->paint, &p->s, &p->run);
}

static void painted_close(struct painted *p)
{
    paint_fixture_close(&p->paint);
    baked_fixture_close(&p->run, &p->s);
}

static size_t count_of(const struct painted *p)
{
    return 3 * (size_t)p->s.width * p->s.height;
}

static float *next_frame(struct painted *p)
{
    fixture_render(&p->s);
    return fixture_read(&p->s, READ_IRRADIANCE);
}

// ---- light of a sun

// A floor, and a wall that no light of a sun in the zenith meets.
static void corner(struct painted *p, struct gpu *gpu)
{
    struct frame_fixture *s = &p->s;
    fixture_init(s, gpu);
    fixture_floor(s, 1, fixture_matte(s, vec3_of(0.8f, 0.5f, 0.2f)));
    fixture_quad(s, vec3_of(-1, 0, -1.3f), vec3_of(1, 0, -1.3f), vec3_of(1, 2, -1.3f),
                 vec3_of(-1, 2, -1.3f), fixture_matte(s, vec3_of(0.3f, 0.5f, 0.9f)));
    fixture_look(s, vec3_of(0, 1.5f, 2.5f), vec3_of(0, 0.6f, -1));
}

static vec3s lit_floor(vec3s position, vec3s normal)
{
    (void)normal;
    return position.y == 0.0f && position.z > -1.1f ? LIT : vec3_of(0, 0, 0);
}

// Inside of the border, where lookups have the floor's whole light. Where there is no surface,
// positions are 0.
static bool is_inner_floor(const float *at)
{
    return fabsf(at[1]) < 1e-3f && fabsf(at[0]) < 0.9f && fabsf(at[2]) < 0.9f && at[0] != 0.0f;
}

// Light of a sun is not shown by the light map, paint is.
static void check_same_light(struct painted *p, const float *sun, const float *painted)
{
    float *position = fixture_read(&p->s, READ_POSITION);
    double worst = 0.0, least = HUGE_VAL;
    for (size_t i = 0; i < count_of(p); i++) {
        const float *at = position + i / 3 * 3;
        const bool wall = at[2] < -1.2f;
        if (!wall && !is_inner_floor(at)) continue;
        const double expected = (double)sun[i] + (wall ? 0.0 : (double)LIT.raw[i % 3]);
        worst = fmax(worst, fabs((double)painted[i] / expected - 1.0));
        if (wall) least = fmin(least, (double)sun[i]);
    }
    print_message("paint differs from a sun by %.2g; least light of the wall %.3f lux\n", worst,
                  least);
    CHECK(worst <= ROUNDING && least > 0.0);
    free(position);
}

static void check_sun(struct gpu *gpu, const char *spec)
{
    struct painted p;
    corner(&p, gpu);
    fixture_add_sun(&p.s, vec3_of(0, -1, 0), LIT);
    painted_open(&p, spec);
    float *sun = next_frame(&p);
    p.s.input.light_count = 0;
    paint_fixture_paint(&p.paint, lit_floor);
    float *painted = next_frame(&p);
    check_same_light(&p, sun, painted);
    free(sun);
    free(painted);
    painted_close(&p);
}

TEST_GPU(paint_gives_the_indirect_light_of_a_sun_of_equal_irradiance)
{
    for (int i = 0; i < SPEC_COUNT; i++) check_sun(gpu, SPECS[i]);
}

// Scattered light replaces direct light of the sun, which the frame has; of paint it has none.
TEST_GPU(paint_scatters_below_surfaces_as_light_of_a_sun)
{
    check_sun(gpu, "ort:texels=1024,offsets=100,transfer=both,mm_per_unit=50");
}

// ---- sums, multiples, zero

static void room(struct painted *p, struct gpu *gpu)
{
    struct frame_fixture *s = &p->s;
    fixture_init(s, gpu);
    fixture_box(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
                fixture_matte(s, vec3_of(0.7f, 0.6f, 0.5f)));
    fixture_box(s, vec3_of(-0.4f, 0.4f, -0.6f), vec3_of(0.8f, 1.6f, 0.5f), false,
                fixture_matte(s, vec3_of(0.8f, 0.4f, 0.2f)));
    fixture_look(s, vec3_of(-1.7f, 2.6f, 1.7f), vec3_of(1, 0.5f, -1));
}

static vec3s spot(vec3s position, vec3s normal)
{
    const float d2 = glms_vec3_distance2(position, vec3_of(1, 0, 0.5f));
    (void)normal;
    return glms_vec3_scale(LIT, expf(-d2));
}

static vec3s twice_the_spot(vec3s position, vec3s normal)
{
    return glms_vec3_scale(spot(position, normal), 2.0f);
}

// Beyond the half floats of an unscaled image.
static vec3s bright_spot(vec3s position, vec3s normal)
{
    return glms_vec3_scale(spot(position, normal), 1024.0f);
}

static void check_equal(const struct painted *p, const float *a, const float *b)
{
    assert_memory_equal(a, b, count_of(p) * sizeof *a);
}

TEST_GPU(twice_the_paint_is_twice_the_light_and_zeros_are_no_paint)
{
    for (int i = 0; i < SPEC_COUNT; i++) {
        struct painted p;
        room(&p, gpu);
        painted_open(&p, SPECS[i]);
        float *dark = next_frame(&p);
        paint_fixture_paint(&p.paint, spot);
        float *once = next_frame(&p), *kept = next_frame(&p);
        paint_fixture_paint(&p.paint, twice_the_spot);
        float *twice = next_frame(&p);
        paint_fixture_paint(&p.paint, bright_spot);
        float *bright = next_frame(&p);
        paint_fixture_paint(&p.paint, spot);
        float *again = next_frame(&p);
        paint_fixture_clear(&p.paint);
        float *cleared = next_frame(&p);
        for (size_t k = 0; k < count_of(&p); k++) {
            CHECK(once[k] > 0.0f && dark[k] == 0.0f);
            CHECK(twice[k] == 2.0f * once[k]); // at half the scale
            CHECK(bright[k] == 1024.0f * once[k]);
        }
        check_equal(&p, once, kept);
        check_equal(&p, once, again);
        check_equal(&p, dark, cleared);
        float *all[] = { dark, once, kept, twice, bright, again, cleared };
        for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
        painted_close(&p);
    }
}

TEST_GPU(paint_is_added_to_other_light_and_zeros_restore_the_image)
{
    for (int i = 0; i < SPEC_COUNT; i++) {
        struct painted p;
        double worst = 0.0;
        room(&p, gpu);
        fixture_add_point(&p.s, vec3_of(1, 2.5f, 1), vec3_of(300, 200, 100));
        painted_open(&p, SPECS[i]);
        float *point = next_frame(&p);
        paint_fixture_paint(&p.paint, spot);
        float *both = next_frame(&p);
        p.s.input.light_count = 0;
        float *paint = next_frame(&p);
        p.s.input.light_count = 1;
        paint_fixture_clear(&p.paint);
        float *restored = next_frame(&p);
        for (size_t k = 0; k < count_of(&p); k++) {
            const double sum = (double)point[k] + (double)paint[k];
            worst = fmax(worst, fabs((double)both[k] / sum - 1.0));
        }
        print_message("the sum differs by %.2g\n", worst);
        CHECK(worst <= 2 * ROUNDING);
        check_equal(&p, point, restored);
        float *all[] = { point, both, paint, restored };
        for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
        painted_close(&p);
    }
}

// A frame whose light is kept computes nothing: no pass `direct`.
static bool has_pass(struct gpu *gpu, const char *name)
{
    struct gpu_timing t[128];
    const int count = gpu_frame_timings(gpu, t, 128);
    for (int i = 0; i < count; i++)
        if (strstr(t[i].name, name)) return true;
    return false;
}

TEST_GPU(kept_light_is_computed_again_after_paint_alone)
{
    if (!gpu_limits(gpu)->timestamps) test_skip("no timestamps");
    for (int i = 0; i < SPEC_COUNT; i++) {
        struct painted p;
        const char *pass = i == 0 ? "ort.direct" : "radiosity.direct";
        room(&p, gpu);
        fixture_add_point(&p.s, vec3_of(1, 2.5f, 1), vec3_of(3000, 2000, 1000));
        painted_open(&p, SPECS[i]);
        for (int frame = 0; frame < 6; frame++) {
            const bool paints = frame == 2 || frame == 4;
            if (paints) paint_fixture_paint(&p.paint, frame == 2 ? spot : twice_the_spot);
            fixture_render(&p.s);
            CHECK(has_pass(gpu, pass) == (frame == 0 || paints));
            CHECK(has_pass(gpu, ".paint") == paints);
        }
        painted_close(&p);
    }
}

// ---- sides

static void shelf(struct painted *p, struct gpu *gpu)
{
    struct frame_fixture *s = &p->s;
    struct material both = material_default();
    both.base_color = vec4_of(vec3_of(0.5f, 0.5f, 0.5f), 1);
    both.metallic = 0;
    both.roughness = 1;
    both.double_sided = true;
    fixture_init(s, gpu);
    const int matte = fixture_matte(s, vec3_of(0.6f, 0.6f, 0.6f));
    fixture_floor(s, 1, matte);
    fixture_quad(s, vec3_of(-1, 1, 1), vec3_of(1, 1, 1), vec3_of(1, 1, -1), vec3_of(-1, 1, -1),
                 fixture_material(s, &both));
    fixture_quad(s, vec3_of(-1, 2, -1), vec3_of(1, 2, -1), vec3_of(1, 2, 1), vec3_of(-1, 2, 1),
                 matte);
    fixture_look(s, vec3_of(0, 1.1f, 5), vec3_of(0, 1, 0));
}

static vec3s lit_below(vec3s position, vec3s normal)
{
    return position.y == 1.0f && normal.y < 0.0f ? LIT : vec3_of(0, 0, 0);
}

static vec3s lit_above(vec3s position, vec3s normal)
{
    return position.y == 1.0f && normal.y > 0.0f ? LIT : vec3_of(0, 0, 0);
}

static double mean_at_height(struct painted *p, const float *e, float y)
{
    float *position = fixture_read(&p->s, READ_POSITION);
    double sum = 0.0;
    int pixels = 0;
    for (size_t i = 0; i < count_of(p); i += 3)
        if (fabsf(position[i + 1] - y) < 1e-3f && position[i] != 0.0f) {
            sum += (double)e[i];
            pixels++;
        }
    free(position);
    CHECK(pixels > 0);
    return sum / pixels;
}

TEST_GPU(paint_on_one_side_lights_what_that_side_faces)
{
    for (int i = 0; i < SPEC_COUNT; i++)
        for (int above = 0; above < 2; above++) {
            struct painted p;
            shelf(&p, gpu);
            painted_open(&p, SPECS[i]);
            CHECK(charts_sides(&p.paint.charts) == 2);
            paint_fixture_paint(&p.paint, above ? lit_above : lit_below);
            float *e = next_frame(&p);
            const double floor = mean_at_height(&p, e, 0.0f), ceiling = mean_at_height(&p, e, 2.0f);
            print_message("%s: floor %.2f lux, ceiling %.2f lux\n", above ? "above" : "below",
                          floor, ceiling);
            CHECK((above ? ceiling : floor) > 20.0 * (above ? floor : ceiling));
            free(e);
            painted_close(&p);
        }
}

// ---- arguments

TEST_GPU(areas_beyond_the_light_map_and_wrong_values_change_nothing)
{
    struct painted p;
    room(&p, gpu);
    painted_open(&p, SPECS[0]);
    const uint32_t w = p.paint.charts.width, h = p.paint.charts.height;
    const struct light_map_area wrong[] = {
        { w, 0, 1, 1, false, NULL },          { 0, h, 1, 1, false, NULL },
        { 0, 0, w + 1, 1, false, NULL },      { 1, 0, w, 1, false, NULL },
        { 0, 1, 1, h, false, NULL },          { 0, 0, 0, 1, false, NULL },
        { 0, 0, 1, 1, true, NULL },           { UINT32_MAX, 0, 2, 1, false, NULL },
        { 1, 0, UINT32_MAX, 1, false, NULL },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) CHECK(!gi_paint(p.run.gi, &wrong[i]));
    static const float VALUES[] = { -1.0f, NAN, INFINITY };
    for (int i = 0; i < 3; i++) {
        const float lux[6] = { 1, 1, 1, 1, VALUES[i], 1 };
        const struct light_map_area area = { w / 2, h / 2, 2, 1, false, lux };
        CHECK(!gi_paint(p.run.gi, &area));
        CHECK(strstr(test_last_message(), "it must be finite and at least 0"));
    }
    CHECK(gi_painted(p.run.gi) == 0.0f);
    float *e = next_frame(&p);
    for (size_t i = 0; i < count_of(&p); i++) CHECK(e[i] == 0.0f);
    free(e);
    painted_close(&p);
}
