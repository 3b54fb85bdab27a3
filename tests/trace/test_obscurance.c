// Traced obscurance and ambient occlusion against closed forms. The point is the origin, on a
// floor, and the radius R 2 m.
#include "trace/stage.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float R = 2.0f;
static const float FAR = 50.0f;

// 256 pixels of 64 rays each, well spread: a standard deviation of 1/2 makes less than 1/2/√16384 =
// 0.004.
static const double TOLERANCE = 0.006;

static void floor_below(struct stage *s)
{
    stage_init(s);
    s->options.obscurance_radius_m = R;
    // Straight down; so narrow that all pixels see the same point.
    s->camera = camera_look_at(vec3_of(0.0f, 1.0f, 0.0f), vec3_of(0, 0, 0), 1e-4f, 0.001f);
    s->camera.up = vec3_of(0, 0, -1);
    stage_quad(s, vec3_of(-FAR, 0, FAR), vec3_of(FAR, 0, FAR), vec3_of(FAR, 0, -FAR),
               vec3_of(-FAR, 0, -FAR), stage_matte(s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0)));
}

struct found {
    double hemisphere, sphere, ambient;
};

static struct found find(struct stage *s)
{
    struct found f;
    f.ambient = stage_mean(s, REFERENCE_AMBIENT_OCCLUSION).mean[0];
    f.hemisphere = stage_mean(s, REFERENCE_OBSCURANCE).mean[0];
    s->options.obscurance_sphere = true;
    f.sphere = stage_mean(s, REFERENCE_OBSCURANCE).mean[0];
    s->options.obscurance_sphere = false;
    return f;
}

// Share of a hemisphere's volume below the height h (radii).
static double below(double h)
{
    return h < 1.0 ? 1.5 * (h - h * h * h / 3.0) : 1.0;
}

TEST(a_floor_leaves_the_hemisphere_open_and_half_of_the_sphere)
{
    struct stage s;
    floor_below(&s);
    const struct found f = find(&s);
    CHECK_NEAR(f.hemisphere, 1.0, 1e-6);
    CHECK_NEAR(f.sphere, 0.5, 1e-6);
    CHECK_NEAR(f.ambient, 1.0, 1e-3); // the mean of 2 cos θ, by the rays' evenness alone
    stage_finish(&s);
}

// A wall at the distance a (radii) cuts a cap of the height 1 − a off the ball: (2 + 3a − a³)/4 is
// left, and the floor halves that. Directions reach it within R where their share along its normal
// is more than a: of the cosine-weighted sky (2/π) ∫ √(1 − u²) du from a to 1, over 2.
TEST(a_wall_cuts_a_cap_off)
{
    for (int i = 0; i < 4; i++) {
        const double a = 0.05 + 0.25 * i, x = -a * (double)R;
        struct stage s;
        floor_below(&s);
        stage_quad(&s, vec3_of((float)x, 0, FAR), vec3_of((float)x, 0, -FAR),
                   vec3_of((float)x, FAR, -FAR), vec3_of((float)x, FAR, FAR), 0);
        const struct found f = find(&s);
        const double open = (2 + 3 * a - a * a * a) / 4;
        CHECK_NEAR(f.hemisphere, open, TOLERANCE);
        CHECK_NEAR(f.sphere, 0.5 * open, TOLERANCE);
        CHECK_NEAR(f.ambient, 1.0 - (acos(a) - a * sqrt(1 - a * a)) / GLM_PI, TOLERANCE);
        stage_finish(&s);
    }
}

// A step down at the distance a: the sphere misses only the quarter that is floor, cut by a plane.
TEST(behind_an_edge_the_sphere_is_open_and_the_hemisphere_has_nothing_to_see)
{
    const float a = 0.4f;
    struct stage s;
    stage_init(&s);
    s.options.obscurance_radius_m = R;
    s.camera = camera_look_at(vec3_of(0.0f, 1.0f, 0.0f), vec3_of(0, 0, 0), 1e-4f, 0.001f);
    s.camera.up = vec3_of(0, 0, -1);
    const int matte = stage_matte(&s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0));
    const float edge = a * R;
    stage_quad(&s, vec3_of(-FAR, 0, FAR), vec3_of(edge, 0, FAR), vec3_of(edge, 0, -FAR),
               vec3_of(-FAR, 0, -FAR), matte);
    stage_quad(&s, vec3_of(edge, -FAR, FAR), vec3_of(edge, -FAR, -FAR), vec3_of(edge, 0, -FAR),
               vec3_of(edge, 0, FAR), matte);
    const struct found f = find(&s);
    const double d = (double)a;
    CHECK_NEAR(f.hemisphere, 1.0, 1e-6);
    CHECK_NEAR(f.sphere, 1.0 - (2 + 3 * d - d * d * d) / 8, TOLERANCE);
    stage_finish(&s);
}

static void shelf(struct stage *s, float height, bool facing_up, int material)
{
    const float y = height * R;
    if (facing_up)
        stage_quad(s, vec3_of(-FAR, y, FAR), vec3_of(FAR, y, FAR), vec3_of(FAR, y, -FAR),
                   vec3_of(-FAR, y, -FAR), material);
    else
        stage_quad(s, vec3_of(-FAR, y, -FAR), vec3_of(FAR, y, -FAR), vec3_of(FAR, y, FAR),
                   vec3_of(-FAR, y, FAR), material);
}

// Matter begins at fronts and ends at backs; the camera is below the shelves.
TEST(above_a_slab_it_is_open_again)
{
    struct stage s;
    floor_below(&s);
    shelf(&s, 0.6f, false, 0);
    shelf(&s, 0.7f, true, 0);
    const struct found f = find(&s);
    CHECK_NEAR(f.hemisphere, 1.0 - below(0.7) + below(0.6), TOLERANCE);
    CHECK_NEAR(f.sphere, 0.5 * (1.0 - below(0.7) + below(0.6)), TOLERANCE);
    CHECK_NEAR(f.ambient, 0.36, TOLERANCE); // directions below the slope of R to the shelf: h²
    stage_finish(&s);
}

TEST(behind_a_sheet_all_counts_as_matter_and_behind_a_lone_back_nothing)
{
    for (int sheet = 0; sheet < 2; sheet++) {
        struct stage s;
        floor_below(&s);
        struct material m = material_default();
        m.double_sided = sheet;
        shelf(&s, 0.6f, true, stage_material(&s, &m));
        const struct found f = find(&s);
        CHECK_NEAR(f.hemisphere, sheet ? below(0.6) : 1.0, sheet ? TOLERANCE : 1e-5);
        stage_finish(&s);
    }
}

// A ceiling at the height h over all: a ray with the cosine μ meets it at r = h/μ, so that with c =
// γ h
//     1 − 2 ∫ μ/(1 + c/μ) dμ = 2c − 2c² ln(1 + 1/c).
TEST(with_a_decay_a_ceiling_hides_the_less_the_higher_it_is)
{
    for (int i = 0; i < 3; i++) {
        const double decay = 0.25 * (double)(1 << 2 * i), h = 0.5; // 1/m, m
        const double c = decay * h, due = 2 * c - 2 * c * c * log(1 + 1 / c);
        struct stage s;
        floor_below(&s);
        s.options.obscurance_radius_m = 1e6f;
        s.options.occlusion_decay_per_m = (float)decay;
        shelf(&s, (float)h / R, false, 0);
        const double found = stage_mean(&s, REFERENCE_AMBIENT_OCCLUSION).mean[0];
        print_message("decay %g 1/m: %.4f, due %.4f\n", decay, found, due);
        // The ceiling ends at 50 m, 100 times its height: of the sky (h/50 m)² is open.
        CHECK_NEAR(found, due, TOLERANCE);
        stage_finish(&s);
    }
}

static struct image layer_of(struct reference *r)
{
    struct image image = { 0 };
    assert_true(reference_read(r, REFERENCE_OBSCURANCE, &image));
    return image;
}

TEST(obscurance_has_as_many_rays_as_samples_however_often_it_is_read)
{
    struct stage s;
    stage_builtin(&s, "@cornell:light=point");
    struct reference *once = stage_reference(&s), *often = stage_reference(&s);
    assert_true(reference_render(once, 9, NULL, NULL));
    for (int i = 0; i < 3; i++) {
        assert_true(reference_render(often, 3, NULL, NULL));
        if (i == 2) break;
        struct image unused = layer_of(often);
        image_finish(&unused, test_host());
    }
    struct image a = layer_of(once), b = layer_of(often);
    assert_int_equal(a.channels, 1);
    assert_memory_equal(a.pixels, b.pixels, (size_t)a.width * (size_t)a.height * sizeof *a.pixels);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    reference_destroy(once);
    reference_destroy(often);
    stage_finish(&s);
}

TEST(a_radius_of_nothing_and_a_decay_below_it_are_refused)
{
    struct stage s;
    floor_below(&s);
    assert_true(pose_init(&s.pose, s.scene, -1, 0));
    const float wrong[] = { 0.0f, -1.0f, INFINITY, NAN };
    for (int i = 0; i < 4; i++) {
        s.options.obscurance_radius_m = wrong[i];
        test_forget_messages();
        CHECK(!reference_create(test_host(), &s.pose, &s.camera, 4, 4, &s.options));
        CHECK(strstr(test_last_message(), "radius"));
    }
    s.options.obscurance_radius_m = R;
    const float wrong_decays[] = { -1.0f, INFINITY, NAN };
    for (int i = 0; i < 3; i++) {
        s.options.occlusion_decay_per_m = wrong_decays[i];
        test_forget_messages();
        CHECK(!reference_create(test_host(), &s.pose, &s.camera, 4, 4, &s.options));
        CHECK(strstr(test_last_message(), "decay"));
    }
    stage_finish(&s);
}
