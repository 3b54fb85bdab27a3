// Boxes, orthonormal bases and transforms.
#include "framework/test.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/vec.h"

#include <math.h>

static void check_vec3(vec3s a, vec3s b, double tolerance)
{
    for (int i = 0; i < 3; i++) CHECK_NEAR(a.raw[i], b.raw[i], tolerance);
}

static vec3s random_point(struct rng *rng)
{
    float x = rng_float(rng), y = rng_float(rng), z = rng_float(rng);
    return vec3_of(20.0f * x - 10.0f, 20.0f * y - 10.0f, 20.0f * z - 10.0f);
}

TEST(empty_box_grows_to_its_first_point)
{
    struct box3 box = box3_empty();
    CHECK(box3_is_empty(box));
    check_vec3(box3_size(box), vec3_of(0.0f, 0.0f, 0.0f), 0.0);
    box = box3_add_point(box, vec3_of(1.0f, -2.0f, 3.0f));
    CHECK(!box3_is_empty(box));
    check_vec3(box.min, vec3_of(1.0f, -2.0f, 3.0f), 0.0);
    check_vec3(box.max, vec3_of(1.0f, -2.0f, 3.0f), 0.0);
}

TEST(box_is_the_smallest_that_contains_its_points)
{
    struct box3 box = box3_empty();
    box = box3_add_point(box, vec3_of(1.0f, 5.0f, -3.0f));
    box = box3_add_point(box, vec3_of(-1.0f, 7.0f, -2.0f));
    check_vec3(box.min, vec3_of(-1.0f, 5.0f, -3.0f), 0.0);
    check_vec3(box.max, vec3_of(1.0f, 7.0f, -2.0f), 0.0);
    check_vec3(box3_centre(box), vec3_of(0.0f, 6.0f, -2.5f), 0.0);
    check_vec3(box3_size(box), vec3_of(2.0f, 2.0f, 1.0f), 0.0);
}

TEST(union_with_the_empty_box_is_the_other)
{
    struct box3 box = box3_add_point(box3_empty(), vec3_of(1.0f, 2.0f, 3.0f));
    box = box3_add_point(box, vec3_of(4.0f, 0.0f, 5.0f));
    struct box3 same = box3_union(box3_empty(), box);
    check_vec3(same.min, box.min, 0.0);
    check_vec3(same.max, box.max, 0.0);
    CHECK(box3_is_empty(box3_union(box3_empty(), box3_empty())));
}

static mat4s random_affine(struct rng *rng)
{
    mat4s m = glms_mat4_identity();
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 3; row++) m.raw[column][row] = 4.0f * rng_float(rng) - 2.0f;
    return m;
}

TEST(transformed_box_is_the_box_of_the_transformed_corners)
{
    struct rng rng = rng_for(1, 0, 0);
    for (int k = 0; k < 100; k++) {
        mat4s m = random_affine(&rng);
        struct box3 box = box3_add_point(box3_empty(), random_point(&rng));
        box = box3_add_point(box, random_point(&rng));
        struct box3 corners = box3_empty(), transformed = box3_transform(m, box);
        for (int c = 0; c < 8; c++)
            corners =
                box3_add_point(corners, mat4_point(m, vec3_of(c & 1 ? box.max.x : box.min.x,
                                                              c & 2 ? box.max.y : box.min.y,
                                                              c & 4 ? box.max.z : box.min.z)));
        check_vec3(transformed.min, corners.min, 1e-4);
        check_vec3(transformed.max, corners.max, 1e-4);
    }
}

TEST(empty_box_stays_empty_through_a_transform)
{
    struct rng rng = rng_for(2, 0, 0);
    CHECK(box3_is_empty(box3_transform(random_affine(&rng), box3_empty())));
}

static void check_basis(vec3s n)
{
    vec3s t, b;
    basis_of(n, &t, &b);
    CHECK_NEAR(glms_vec3_norm(t), 1.0, 1e-6);
    CHECK_NEAR(glms_vec3_norm(b), 1.0, 1e-6);
    CHECK_NEAR(glms_vec3_dot(t, n), 0.0, 1e-6);
    check_vec3(glms_vec3_cross(t, b), n, 2e-6); // right-handed
}

TEST(basis_is_orthonormal_and_right_handed_everywhere)
{
    struct rng rng = rng_for(3, 0, 0);
    for (int k = 0; k < 10000; k++) check_basis(sample_sphere(rng_vec2(&rng)));
    check_basis(vec3_of(0.0f, 0.0f, 1.0f));
    check_basis(vec3_of(0.0f, 0.0f, -1.0f));
    check_basis(vec3_of(1.0f, 0.0f, 0.0f));
    check_basis(vec3_of(0.0f, 1.0f, -0.0f));
    check_basis(glms_vec3_normalize(vec3_of(1e-4f, -1e-4f, -1.0f)));
}

TEST(unit_vectors_have_length_one_for_any_input_length)
{
    static const float lengths[] = { 1e-44f, 1e-38f, 1e-20f, 1.0f, 1e20f, 3e38f };
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        vec3s unit = vec3_unit(vec3_of(0, -lengths[i], 0));
        CHECK(unit.x == 0.0f && unit.y == -1.0f && unit.z == 0.0f);
        vec3s slanted = vec3_unit(vec3_of(lengths[i], lengths[i], -lengths[i]));
        CHECK_NEAR(glms_vec3_norm(slanted), 1.0f, 1e-6f);
    }
    CHECK(glms_vec3_norm(vec3_unit(vec3_of(0, 0, 0))) == 0.0f);
    CHECK(glms_vec3_norm(vec3_unit(vec3_of(0, INFINITY, 0))) == 0.0f);
    vec3s far = vec3_towards(vec3_of(-3e38f, 0, 0), vec3_of(3e38f, 0, 0));
    CHECK(far.x == 1.0f && far.y == 0.0f && far.z == 0.0f);
}

TEST(translation_moves_points_but_not_directions)
{
    mat4s move = glms_translate_make(vec3_of(1.0f, 2.0f, 3.0f));
    check_vec3(mat4_point(move, vec3_of(1.0f, 1.0f, 1.0f)), vec3_of(2.0f, 3.0f, 4.0f), 0.0);
    check_vec3(mat4_direction(move, vec3_of(1.0f, 1.0f, 1.0f)), vec3_of(1.0f, 1.0f, 1.0f), 0.0);
}

TEST(luminance_of_white_is_one)
{
    CHECK_NEAR(luminance(vec3_of(1.0f, 1.0f, 1.0f)), 1.0, 1e-6);
    CHECK_NEAR(luminance(vec3_of(0.0f, 1.0f, 0.0f)), 0.7152, 1e-6);
}
