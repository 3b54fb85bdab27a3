// Ray-traced obscurance and ambient occlusion against closed forms, at the origin on a floor, with
// the radius R = 2 m.
#include "trace/trace_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const float R = 2.0f;
static const float FAR = 50.0f;

// 256 pixels of 64 stratified rays: a standard deviation of 1/2 gives less than 1/2/√16384 = 0.004.
static const double TOLERANCE = 0.006;

static void floor_below(struct trace_fixture *s)
{
    fixture_init(s);
    s->options.obscurance_radius_m = R;
    // Straight down, with a field of view so narrow that all pixels see the same point.
    s->camera = camera_look_at(vec3_of(0.0f, 1.0f, 0.0f), vec3_of(0, 0, 0), 1e-4f, 0.001f);
    s->camera.up = vec3_of(0, 0, -1);
    fixture_quad(s, vec3_of(-FAR, 0, FAR), vec3_of(FAR, 0, FAR), vec3_of(FAR, 0, -FAR),
                 vec3_of(-FAR, 0, -FAR),
                 fixture_diffuse(s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0)));
}

struct visibility {
    double hemisphere, sphere, ambient;
};

static struct visibility measure(struct trace_fixture *s)
{
    struct visibility f;
    f.ambient = fixture_mean(s, REFERENCE_AMBIENT_OCCLUSION).mean[0];
    f.hemisphere = fixture_mean(s, REFERENCE_OBSCURANCE).mean[0];
    s->options.obscurance_sphere = true;
    f.sphere = fixture_mean(s, REFERENCE_OBSCURANCE).mean[0];
    s->options.obscurance_sphere = false;
    return f;
}

// Share of a hemisphere's volume below the height h (radii).
static double below(double h)
{
    return h < 1.0 ? 1.5 * (h - h * h * h / 3.0) : 1.0;
}

TEST(on_a_plane_the_hemisphere_and_half_of_the_sphere_are_empty)
{
    struct trace_fixture s;
    floor_below(&s);
    const struct visibility f = measure(&s);
    CHECK_NEAR(f.hemisphere, 1.0, 1e-6);
    CHECK_NEAR(f.sphere, 0.5, 1e-6);
    CHECK_NEAR(f.ambient, 1.0, 1e-3); // the mean of 2 cos θ over stratified rays
    fixture_finish(&s);
}

// A wall at the distance a (radii) cuts off a spherical cap of the height 1 − a: the share
// (2 + 3a − a³)/4 of the volume remains, and the floor halves it. A direction hits the wall within
// R if its cosine to the wall's normal is above a; their cosine-weighted share of the hemisphere is
// (1/π) ∫ √(1 − u²) du from a to 1.
TEST(a_wall_cuts_off_a_spherical_cap)
{
    for (int i = 0; i < 4; i++) {
        const double a = 0.05 + 0.25 * i, x = -a * (double)R;
        struct trace_fixture s;
        floor_below(&s);
        fixture_quad(&s, vec3_of((float)x, 0, FAR), vec3_of((float)x, 0, -FAR),
                     vec3_of((float)x, FAR, -FAR), vec3_of((float)x, FAR, FAR), 0);
        const struct visibility f = measure(&s);
        const double open = (2 + 3 * a - a * a * a) / 4;
        CHECK_NEAR(f.hemisphere, open, TOLERANCE);
        CHECK_NEAR(f.sphere, 0.5 * open, TOLERANCE);
        CHECK_NEAR(f.ambient, 1.0 - (acos(a) - a * sqrt(1 - a * a)) / GLM_PI, TOLERANCE);
        fixture_finish(&s);
    }
}

// A step down at the distance a: the sphere contains a quarter sphere of matter, cut by a plane.
TEST(beyond_an_edge_the_sphere_is_empty_and_the_hemisphere_unoccluded)
{
    const float a = 0.4f;
    struct trace_fixture s;
    fixture_init(&s);
    s.options.obscurance_radius_m = R;
    s.camera = camera_look_at(vec3_of(0.0f, 1.0f, 0.0f), vec3_of(0, 0, 0), 1e-4f, 0.001f);
    s.camera.up = vec3_of(0, 0, -1);
    const int matte = fixture_diffuse(&s, vec3_of(0.5f, 0.5f, 0.5f), vec3_of(0, 0, 0));
    const float edge = a * R;
    fixture_quad(&s, vec3_of(-FAR, 0, FAR), vec3_of(edge, 0, FAR), vec3_of(edge, 0, -FAR),
                 vec3_of(-FAR, 0, -FAR), matte);
    fixture_quad(&s, vec3_of(edge, -FAR, FAR), vec3_of(edge, -FAR, -FAR), vec3_of(edge, 0, -FAR),
                 vec3_of(edge, 0, FAR), matte);
    const struct visibility f = measure(&s);
    const double d = (double)a;
    CHECK_NEAR(f.hemisphere, 1.0, 1e-6);
    CHECK_NEAR(f.sphere, 1.0 - (2 + 3 * d - d * d * d) / 8, TOLERANCE);
    fixture_finish(&s);
}

static void shelf(struct trace_fixture *s, float height, bool facing_up, int material)
{
    const float y = height * R;
    if (facing_up)
        fixture_quad(s, vec3_of(-FAR, y, FAR), vec3_of(FAR, y, FAR), vec3_of(FAR, y, -FAR),
                     vec3_of(-FAR, y, -FAR), material);
    else
        fixture_quad(s, vec3_of(-FAR, y, -FAR), vec3_of(FAR, y, -FAR), vec3_of(FAR, y, FAR),
                     vec3_of(-FAR, y, FAR), material);
}

// Matter begins at front faces and ends at back faces; the camera is below the shelves.
TEST(volume_above_a_slab_is_empty)
{
    struct trace_fixture s;
    floor_below(&s);
    shelf(&s, 0.6f, false, 0);
    shelf(&s, 0.7f, true, 0);
    const struct visibility f = measure(&s);
    CHECK_NEAR(f.hemisphere, 1.0 - below(0.7) + below(0.6), TOLERANCE);
    CHECK_NEAR(f.sphere, 0.5 * (1.0 - below(0.7) + below(0.6)), TOLERANCE);
    CHECK_NEAR(f.ambient, 0.36, TOLERANCE); // directions that miss the shelf within R: h²
    fixture_finish(&s);
}

TEST(double_sided_surfaces_hide_matter_and_single_back_faces_do_not)
{
    for (int sheet = 0; sheet < 2; sheet++) {
        struct trace_fixture s;
        floor_below(&s);
        struct material m = material_default();
        m.double_sided = sheet;
        shelf(&s, 0.6f, true, fixture_material(&s, &m));
        const struct visibility f = measure(&s);
        CHECK_NEAR(f.hemisphere, sheet ? below(0.6) : 1.0, sheet ? TOLERANCE : 1e-5);
        fixture_finish(&s);
    }
}

// An infinite ceiling at the height h: a ray with the cosine μ hits it at r = h/μ, so that with
// c = γ h the visibility is
//     1 − 2 ∫ μ/(1 + c/μ) dμ = 2c − 2c² ln(1 + 1/c).
TEST(decay_reduces_the_occlusion_by_a_higher_ceiling)
{
    for (int i = 0; i < 3; i++) {
        const double decay = 0.25 * (double)(1 << 2 * i), h = 0.5; // 1/m, m
        const double c = decay * h, expected = 2 * c - 2 * c * c * log(1 + 1 / c);
        struct trace_fixture s;
        floor_below(&s);
        s.options.obscurance_radius_m = 1e6f;
        s.options.occlusion_decay_per_m = (float)decay;
        shelf(&s, (float)h / R, false, 0);
        const double measured = fixture_mean(&s, REFERENCE_AMBIENT_OCCLUSION).mean[0];
        print_message("decay %g 1/m: %.4f, expected %.4f\n", decay, measured, expected);
        // The ceiling ends at 50 m, 100 times its height: (h/50 m)² of the sky is visible.
        CHECK_NEAR(measured, expected, TOLERANCE);
        fixture_finish(&s);
    }
}

static struct image layer_of(struct reference *r)
{
    struct image image = { 0 };
    assert_true(reference_read(r, REFERENCE_OBSCURANCE, &image));
    return image;
}

TEST(obscurance_uses_one_ray_per_sample_regardless_of_reads)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell:light=point");
    struct reference *once = fixture_reference(&s), *often = fixture_reference(&s);
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
    fixture_finish(&s);
}

TEST(invalid_radius_and_decay_are_refused)
{
    struct trace_fixture s;
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
    fixture_finish(&s);
}
