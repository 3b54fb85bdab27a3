// Transfer of an object to a point beside it: a unit sphere against closed forms, volumes.
#include "framework/test.h"
#include "techniques/dnrt/sphere_fixture.h"

#include "techniques/dnrt/dnrt_part.h"
#include "techniques/dnrt/bake/patches.h"
#include "techniques/dnrt/bake/transfer.h"
#include "techniques/dnrt/bake/volume.h"
#include "techniques/dnrt/dnrt_object.h"

#include "core/half.h"
#include "core/rng.h"
#include "core/sh.h"

#include <math.h>
#include <string.h>

// ---- a unit sphere

struct ball {
    struct traced_shape of;
    struct dnrt_sampling how;
};

// Opens an object with the mesh that `add` makes.
static void object_open(struct ball *ball, float albedo, int (*add)(struct scene *, int material))
{
    struct material material = material_default();
    material.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    material.metallic = 0;
    material.specular = 0; // its reflectance is the albedo
    traced_shape_open(&ball->of, &material, add);
    ball->how = (struct dnrt_sampling){ ball->of.trace, vec3_of(0, 0, 0), 1.0f, 3, 1024, 1, false };
}

static void ball_open(struct ball *ball, float albedo)
{
    object_open(ball, albedo, sphere_fixture_add);
}

static void ball_close(struct ball *ball)
{
    traced_shape_close(&ball->of);
}

// ---- closed forms: a unit sphere of albedo 1, its centre at distance d along `towards`
//
// k: the cone sin θ ≤ 1/d around n_o, 2π ∫ P_l(cos θ) cos θ sin θ dθ / π².
// t: the sphere's points with μ = cos of their normal to −n_o from 1/d to 1. With r² = 1 + d² − 2dμ
// the solid angle times the receiver's cosine is 2π (d − μ)(dμ − 1)/r⁴ dμ; with x = r² and
// a = d² − 1 it is 2π/(8d²) (a²/x² − 1) dx, x from (d − 1)² to a, and μ = (1 + d² − x)/(2d).

static double hidden_of(int band, double d)
{
    const double c = sqrt(1.0 - 1.0 / (d * d));
    const double integral[] = { 0.5 / (d * d), (1.0 - c * c * c) / 3.0,
                                0.375 * (1.0 - pow(c, 4)) - 0.25 * (1.0 - c * c) };
    return integral[band] * 2.0 / M_PI;
}

static double reflected_of(int band, double d)
{
    const double a = d * d - 1.0, b = d * d + 1.0, low = (d - 1.0) * (d - 1.0);
    const double log_ratio = log(a / low);
    // ∫ x^n (a²/x² − 1) dx
    const double i0 = 4.0;
    const double i1 = a * a * log_ratio - 0.5 * (a * a - low * low);
    const double i2 = a * a * (a - low) - (a * a * a - low * low * low) / 3.0;
    const double m1 = (b * i0 - i1) / (2.0 * d);
    const double m2 = (b * b * i0 - 2.0 * b * i1 + i2) / (4.0 * d * d);
    const double p[] = { i0, m1, 1.5 * m2 - 0.5 * i0 };
    return p[band] / (8.0 * d * d) * 2.0 / M_PI;
}

enum { RUNS = 16 };

static void check_mean(const double *values, double exact, const char *what, int j, double d)
{
    double sum = 0, square = 0;
    for (int i = 0; i < RUNS; i++) sum += values[i] / RUNS;
    for (int i = 0; i < RUNS; i++) square += (values[i] - sum) * (values[i] - sum);
    const double error = sqrt(square / (RUNS * (RUNS - 1.0)));
    if (fabs(sum - exact) > 3.0 * error + 5e-4)
        fail_msg("%s_%d at %g: %g ± %g, not %g", what, j, d, sum, error, exact);
}

static void check_distance(const struct ball *ball, double d)
{
    const vec3s to_point = glms_vec3_normalize(vec3_of(0.3f, -0.8f, 0.5f));
    const vec3s n_o = glms_vec3_negate(to_point);
    struct dnrt_transfer at[RUNS];
    float along[9], against[9];
    sh_eval(3, n_o, along);
    sh_eval(3, to_point, against);
    for (int i = 0; i < RUNS; i++)
        dnrt_transfer_at(&ball->how, glms_vec3_scale(to_point, (float)d),
                         pcg_hash((uint32_t)i) | 1u, &at[i]);
    for (int j = 0; j < 9; j++) {
        const int band = j == 0 ? 0 : j < 4 ? 1 : 2;
        double hidden[RUNS], reflected[RUNS];
        for (int i = 0; i < RUNS; i++) {
            hidden[i] = (double)at[i].of[0].hidden[j];
            reflected[i] = (double)at[i].of[0].reflected[j].x;
        }
        check_mean(hidden, hidden_of(band, d) * (double)along[j], "k", j, d);
        check_mean(reflected, reflected_of(band, d) * (double)against[j], "t", j, d);
    }
}

TEST(a_sphere_reflects_and_hides_as_the_closed_forms_say)
{
    struct ball ball;
    ball_open(&ball, 1);
    for (int i = 0; i < 4; i++) check_distance(&ball, (const double[]){ 1.5, 2, 3, 4 }[i]);
    ball_close(&ball);
}

// A lamp behind the receiver, of irradiance 1 on a surface that faces it: the points of normal
// cosine μ have the radiance μ/π, and the receiver 2π/(8d²) ∫ μ/π (a²/x² − 1) dx.
static double lit_by_lamp(double d)
{
    const double a = d * d - 1.0, b = d * d + 1.0, low = (d - 1.0) * (d - 1.0);
    const double i1 = a * a * log(a / low) - 0.5 * (a * a - low * low);
    return (b * 4.0 - i1) / (2.0 * d) / (4.0 * d * d);
}

// π Σ d_j t_j with d_j = A_l Y_j(ω). Three bands of the clamped cosine differ by at most 6 % where
// it is above 1/d.
TEST(a_sphere_reflects_a_lamp_as_the_closed_form_says)
{
    const vec3s to_lamp = glms_vec3_normalize(vec3_of(0.3f, -0.8f, 0.5f));
    struct ball ball;
    float zonal[3], lamp[9];
    ball_open(&ball, 1);
    zh_clamped_cosine(3, zonal);
    zh_rotate(3, zonal, to_lamp, lamp);
    for (int i = 0; i < 3; i++) {
        const double d = (const double[]){ 2, 3, 4 }[i];
        struct dnrt_transfer at;
        double sum = 0;
        dnrt_transfer_at(&ball.how, glms_vec3_scale(to_lamp, (float)d), 1, &at);
        for (int j = 0; j < 9; j++) sum += M_PI * (double)lamp[j] * (double)at.of[0].reflected[j].x;
        print_message("lamp, d = %g: %.4f, exact %.4f\n", d, sum, lit_by_lamp(d));
        CHECK_RELATIVE(sum, lit_by_lamp(d), 0.07);
    }
    ball_close(&ball);
}

// The vector irradiance along n_o, and of the six normals the one that is n_o, which has all of the
// sphere above its horizon, are the irradiance of a receiver that faces the sphere.
static void check_normals(struct ball *ball, int axis, int normals, double d)
{
    vec3s n_o = glms_vec3_normalize(vec3_of(-0.6f, 0.5f, 0.3f));
    struct dnrt_transfer at[RUNS];
    float along[9];
    if (normals == 6) n_o = vec3_of((float)(axis == 0), -(float)(axis == 1), (float)(axis == 2));
    sh_eval(3, n_o, along);
    ball->how.normals = normals;
    for (int i = 0; i < RUNS; i++)
        dnrt_transfer_at(&ball->how, glms_vec3_scale(n_o, (float)-d), pcg_hash((uint32_t)i) | 1u,
                         &at[i]);
    for (int j = 0; j < 9; j++) {
        const int band = j == 0 ? 0 : j < 4 ? 1 : 2;
        const double against = (band == 1 ? -1 : 1) * (double)along[j];
        double hidden[RUNS] = { 0 }, reflected[RUNS] = { 0 };
        for (int i = 0; i < RUNS; i++)
            for (int v = 0; v < normals; v++) {
                const float other = v / 2 == axis && v % 2 == (axis == 1) ? 1.0f : 0.0f;
                const float weight = normals == 3 ? n_o.raw[v] : other;
                hidden[i] += (double)(weight * at[i].of[v].hidden[j]);
                reflected[i] += (double)(weight * at[i].of[v].reflected[j].x);
            }
        check_mean(hidden, hidden_of(band, d) * (double)along[j], "k", j, d);
        check_mean(reflected, reflected_of(band, d) * against, "t", j, d);
    }
}

TEST(several_normals_have_the_irradiance_of_each)
{
    struct ball ball;
    ball_open(&ball, 1);
    for (int i = 0; i < 3; i++) {
        check_normals(&ball, i, 3, (const double[]){ 1.5, 2.5, 4 }[i]);
        check_normals(&ball, i, 6, (const double[]){ 1.5, 2.5, 4 }[i]);
    }
    ball_close(&ball);
}

// (x)₊ − (−x)₊ = x.
TEST(both_ways_of_an_axis_differ_by_the_vector_irradiance)
{
    struct ball ball;
    ball_open(&ball, 0.5f);
    const vec3s point = vec3_of(0.9f, 0.2f, 0.6f);
    struct dnrt_transfer axes, ways;
    ball.how.normals = 3;
    dnrt_transfer_at(&ball.how, point, 5, &axes);
    ball.how.normals = 6;
    dnrt_transfer_at(&ball.how, point, 5, &ways);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 9; j++) {
            const struct dnrt_vectors *plus = &ways.of[2 * i], *minus = &ways.of[2 * i + 1];
            CHECK_NEAR(plus->hidden[j] - minus->hidden[j], axes.of[i].hidden[j], 1e-5);
            CHECK_NEAR(plus->reflected[j].x - minus->reflected[j].x, axes.of[i].reflected[j].x,
                       1e-5);
        }
    ball_close(&ball);
}

// t_0 = k_0 = Y00/(π d²).
TEST(the_closed_forms_agree_in_constant_light)
{
    for (double d = 1.25; d < 8; d *= 1.5) {
        CHECK_RELATIVE(hidden_of(0, d), 1.0 / (M_PI * d * d), 1e-12);
        CHECK_RELATIVE(reflected_of(0, d), hidden_of(0, d), 1e-9);
    }
}

TEST(constant_light_is_not_changed_by_a_white_sphere)
{
    struct ball ball;
    ball_open(&ball, 1);
    for (int i = 0; i < 16; i++) {
        const vec3s point = glms_vec3_scale(vec3_of(0.48f, 0.6f, 0.64f), 1.1f + 0.3f * (float)i);
        struct dnrt_transfer at;
        dnrt_transfer_at(&ball.how, point, 7, &at);
        CHECK_NEAR(at.of[0].reflected[0].x - at.of[0].hidden[0], 0, 1e-6);
        CHECK(at.of[0].hidden[0] > 0);
        CHECK(at.backs == 0);
    }
    ball_close(&ball);
}

TEST(transfer_is_linear_in_the_reflectance)
{
    struct ball white, grey;
    ball_open(&white, 1);
    ball_open(&grey, 0.25f);
    const vec3s point = vec3_of(1.2f, 0.9f, -0.4f);
    struct dnrt_transfer a, b;
    dnrt_transfer_at(&white.how, point, 3, &a);
    dnrt_transfer_at(&grey.how, point, 3, &b);
    for (int j = 0; j < 9; j++) {
        CHECK_NEAR(b.of[0].reflected[j].y, 0.25f * a.of[0].reflected[j].y, 1e-6);
        CHECK(b.of[0].hidden[j] == a.of[0].hidden[j]);
    }
    ball_close(&white);
    ball_close(&grey);
}

TEST(points_inside_are_told_by_the_backs_that_they_see)
{
    struct ball ball;
    ball_open(&ball, 1);
    struct dnrt_transfer inside, outside;
    dnrt_transfer_at(&ball.how, vec3_of(0.5f, 0.2f, 0), 1, &inside);
    dnrt_transfer_at(&ball.how, vec3_of(1.01f, 0, 0), 1, &outside);
    CHECK(inside.backs > 0.99f * (float)ball.how.rays);
    CHECK(outside.backs == 0);
    ball_close(&ball);
}

// ---- self-transfer

TEST(a_convex_object_does_not_shadow_itself)
{
    struct ball ball;
    ball_open(&ball, 0.5f);
    const vec3s point = vec3_of(1.2f, 0.9f, -0.4f);
    struct dnrt_transfer without, with;
    dnrt_transfer_at(&ball.how, point, 3, &without);
    ball.how.self = true;
    dnrt_transfer_at(&ball.how, point, 3, &with);
    for (int j = 0; j < 9; j++)
        CHECK_NEAR(with.of[0].reflected[j].x, without.of[0].reflected[j].x, 1e-4);
    ball_close(&ball);
}

// A bowl's irradiance in constant light is that outside times E with E = ½ + ½ ρ E.
static void check_bowl(float albedo)
{
    struct ball bowl;
    struct dnrt_transfer with, without;
    object_open(&bowl, albedo, bowl_fixture_add);
    const vec3s point = vec3_of(0, 2, 0); // it sees nothing but the inside
    bowl.how.rays = 16384;
    dnrt_transfer_at(&bowl.how, point, 11, &without);
    bowl.how.self = true;
    dnrt_transfer_at(&bowl.how, point, 11, &with);
    const float irradiance = 0.5f / (1 - 0.5f * albedo);
    CHECK_RELATIVE(with.of[0].reflected[0].x, irradiance * without.of[0].reflected[0].x, 0.01);
    CHECK(with.of[0].hidden[0] == without.of[0].hidden[0]);
    ball_close(&bowl);
}

// expected, occluded: of an irradiance of 1 outside, at the points of the patches.
static void check_points(float albedo, int (*add)(struct scene *, int), float expected,
                         float occluded, double tolerance)
{
    struct ball bowl;
    struct dnrt_objects objects;
    struct dnrt_part part;
    struct dnrt_patches patches;
    object_open(&bowl, albedo, add);
    bowl.of.scene->instances[0].movable = true;
    CHECK(dnrt_objects_init(&objects, test_host(), &bowl.of.pose, 1, false));
    CHECK(dnrt_part_init(&part, test_host(), &bowl.of.pose, &objects, 0));
    CHECK(dnrt_patches_init(&patches, test_host(), &part));
    bowl.how.rays = 1024;
    const float y00 = 0.28209479f;
    for (uint32_t point = 5; point < patches.points; point += patches.points / 16) {
        vec4s at[DNRT_MAX_COEFFICIENTS];
        dnrt_self_at(&bowl.how, &patches, point, point + 1, at);
        CHECK_NEAR(at[0].x, y00 * expected, tolerance);
        CHECK_NEAR(at[0].w, y00 * occluded, tolerance);
    }
    dnrt_patches_finish(&patches);
    dnrt_part_finish(&part);
    dnrt_objects_finish(&objects);
    ball_close(&bowl);
}

TEST(points_of_a_bowl_have_the_light_that_the_closed_form_says)
{
    check_points(0, bowl_fixture_add, 0.5f - 1, 0.5f, 0.003);
    check_points(0.8f, bowl_fixture_add, 0.5f / (1 - 0.4f) - 1, 0.5f, 0.003);
}

TEST(points_of_a_sphere_have_the_light_outside)
{
    check_points(0.8f, sphere_fixture_add, 0, 0, 0);
}

TEST(a_bowl_shadows_and_lights_itself_as_the_closed_form_says)
{
    check_bowl(0.2f);
    check_bowl(0.8f);
    check_bowl(1);
}

// ---- volumes

TEST(samples_of_a_quadratic_grid_are_denser_at_the_centre)
{
    const struct dnrt_grid grid = { vec3_of(1, 2, 3), 4, 17, true };
    const vec3s corner = dnrt_grid_point(&grid, 0), centre = dnrt_grid_point(&grid, 8 + 17 * 8);
    CHECK(corner.x == -3 && corner.y == -2 && corner.z == -1);
    CHECK(centre.x == 1 && centre.y == 2);
    CHECK_NEAR(dnrt_grid_point(&grid, 12).x - 1, 4 * 0.25f, 1e-6); // u = ½
    CHECK_NEAR(dnrt_grid_point(&grid, 4).x - 1, -4 * 0.25f, 1e-6);
}

TEST(an_encoded_plane_is_within_half_a_step)
{
    enum { COUNT = 4096 };
    static float values[COUNT];
    static uint8_t bytes[COUNT];
    static uint16_t halves[COUNT];
    struct rng rng = rng_for(1, 2, 3);
    for (int i = 0; i < COUNT; i++) values[i] = 0.03f * (2.0f * rng_float(&rng) - 1.0f);
    const float scale = dnrt_encode_byte(values, COUNT, 1, bytes);
    const float half_scale = dnrt_encode_half(values, COUNT, 1, halves);
    CHECK(scale == half_scale);
    for (int i = 0; i < COUNT; i++) {
        CHECK_NEAR((float)(bytes[i] - 128) / 127.0f * scale, values[i], 0.5001f / 127.0f * scale);
        CHECK_NEAR(float_from_half(halves[i]) * scale, values[i], 0x1p-11f * scale);
    }
}

TEST(zero_stays_zero_in_a_plane)
{
    const float values[3] = { 0.5f, 0, -0.25f };
    uint8_t bytes[3];
    dnrt_encode_byte(values, 3, 1, bytes);
    CHECK(bytes[1] == 128);
}

// No smaller than 0 by half a step of a byte, and not the largest byte of the other sign.
TEST(a_plane_of_denormal_numbers_is_zero)
{
    const float values[4] = { 1e-44f, 0, -1e-44f, 3e-38f };
    uint8_t bytes[4];
    for (int count = 3; count <= 4; count++) {
        const float scale = dnrt_encode_byte(values, count, 1, bytes);
        CHECK(scale == values[count == 3 ? 0 : 3]);
        for (int i = 0; i < count; i++) assert_int_equal(bytes[i], 128);
    }
}

TEST(samples_inside_get_the_mean_of_their_neighbours)
{
    enum { N = 4 };
    uint8_t inside[N * N * N] = { 0 };
    float values[N * N * N];
    for (int i = 0; i < N * N * N; i++) values[i] = (float)(i % N);
    const int at = 1 + N + N * N;
    inside[at] = 1;
    values[at] = 1000;
    CHECK(dnrt_fill_inside(test_host(), N, 1, inside, values));
    CHECK_NEAR(values[at], (0 + 2 + 1 + 1 + 1 + 1) / 6.0f, 1e-6);
}

// ---- frames

TEST(a_frame_is_what_a_matrix_has_beside_its_stretch)
{
    const mat4s stretch = glms_scale_make(vec3_of(2, 1, 0.5f));
    mat4s m = glms_translate_make(vec3_of(3, 4, 5));
    m = glms_rotate(m, 1.1f, vec3_of(0.3f, -0.5f, 0.8f));
    m = glms_mat4_mul(m, glms_scale_make(vec3_of(7, 7, 7)));
    m = glms_mat4_mul(m, stretch);
    struct dnrt_frame frame;
    mat3s rest;
    CHECK(dnrt_frame_of(m, &frame, &rest));
    CHECK_NEAR(frame.scale, 7, 1e-4);
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) CHECK_NEAR(rest.raw[c][r], stretch.raw[c][r], 3e-4);
    const mat4s world = dnrt_world_from_object(&frame);
    const vec3s p = vec3_of(0.2f, -0.7f, 0.4f);
    const vec3s a = mat4_point(world, glms_mat3_mulv(rest, p)), b = mat4_point(m, p);
    CHECK_NEAR(glms_vec3_distance(a, b), 0, 3e-3);
}

TEST(a_mirrored_frame_rotates_without_mirroring)
{
    const mat4s m =
        glms_mat4_mul(glms_rotate_make(0.7f, vec3_of(0, 1, 0)), glms_scale_make(vec3_of(-2, 2, 2)));
    struct dnrt_frame frame;
    mat3s rest;
    CHECK(dnrt_frame_of(m, &frame, &rest));
    CHECK_NEAR(glms_mat3_det(frame.rotation), 1, 1e-5);
    CHECK_NEAR(glms_mat3_det(rest), -1, 1e-3);
    CHECK_NEAR(frame.scale, 2, 1e-5);
}
