// warp=retrace: light in blocks of other proportions than a cube, against rays in a box.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"

#include "techniques/mrt/level/solver.h"

#include <math.h>

enum { TEXELS = 8, RAYS = 512, LIGHTS = 8 };

// A closed block of this size, its walls white.
struct box {
    vec3s half;
    struct mrt_block_map map;
    struct mrt_level level;
    struct mrt_solver solver;
};

static void box_init(struct box *box, vec3s size, const struct mrt_dictionary *dictionary,
                     bool retrace)
{
    const struct mrt_level_options options = { .max_depth = 0,
                                               .retrace = { retrace ? 8 : 0, 16.0f, true } };
    *box = (struct box){ .half = glms_vec3_scale(size, 0.5f) };
    CHECK(mrt_block_map_init(test_host(), "test", 1, &box->map));
    mrt_block_init(&box->map.blocks[0], "box", MRT_BLOCK_CUBE);
    mrt_block_set_box(&box->map.blocks[0], (struct box3){ glms_vec3_negate(box->half), box->half });
    CHECK(mrt_level_init(test_host(), &box->map, dictionary, &options, &box->level));
    CHECK(mrt_solver_init(test_host(), &box->level, &box->solver));
}

static void box_finish(struct box *box)
{
    mrt_solver_finish(&box->solver);
    mrt_level_finish(&box->level);
    mrt_block_map_finish(&box->map);
}

// Irradiance of a point light of 1 cd at a wall.
static float direct(vec3s light, vec3s at, vec3s inward)
{
    const vec3s to = glms_vec3_sub(light, at);
    const float square = glms_vec3_norm2(to);
    return fmaxf(glms_vec3_dot(to, inward), 0.0f) / (square * sqrtf(square));
}

static float direct_beyond(const struct box *box, vec3s light, vec3s from, vec3s ray)
{
    float nearest = INFINITY;
    int axis = 0;
    for (int a = 0; a < 3; a++) {
        const float wall = copysignf(box->half.raw[a], ray.raw[a]);
        const float distance = ray.raw[a] == 0.0f ? INFINITY : (wall - from.raw[a]) / ray.raw[a];
        if (distance >= nearest) continue;
        nearest = distance;
        axis = a;
    }
    vec3s inward = vec3_of(0, 0, 0);
    inward.raw[axis] = -copysignf(1.0f, ray.raw[axis]);
    return direct(light, glms_vec3_muladds(ray, nearest, from), inward);
}

// One bounce at a texel, by cosine-distributed rays.
static float bounce(const struct box *box, vec3s light, vec3s at, mat3s frame)
{
    float sum = 0.0f;
    for (uint32_t k = 0; k < RAYS; k++) {
        const vec3s local = sample_hemisphere_cosine(sobol_2d(k, 1));
        sum += direct_beyond(box, light, at, glms_mat3_mulv(frame, local));
    }
    return sum / RAYS;
}

struct sums {
    double difference, all;
};

static void compare_light(struct box *box, vec3s light, struct sums *sums)
{
    enum { ALL = CUBE_FACES * TEXELS * TEXELS };
    static float radiosity[3 * ALL], irradiance[3 * ALL], truth[ALL];
    const struct mrt_shape shape = mrt_level_cell(&box->level, 0);
    for (int i = 0; i < ALL; i++) {
        const struct mrt_point point = mrt_shape_texel(&shape, i);
        const vec3s at = glms_vec3_mul(glms_vec3_scale(point.position, 2.0f), box->half);
        truth[i] = bounce(box, light, at, point.frame);
        for (int c = 0; c < 3; c++) radiosity[3 * i + c] = direct(light, at, point.frame.col[2]);
    }
    mrt_solve(&box->solver, radiosity, irradiance);
    for (int i = 0; i < ALL; i++) {
        const double error = (double)irradiance[3 * i] - (double)truth[i];
        sums->difference += error * error;
        sums->all += (double)truth[i] * (double)truth[i];
    }
}

// Relative L2 error over some lights, at least a fifth of the shortest edge from the walls.
static double error_of(vec3s size, const struct mrt_dictionary *dictionary, bool retrace)
{
    struct box box;
    struct sums sums = { 0 };
    struct rng rng = rng_for(1, 0, 0);
    const float near = 0.2f * fminf(fminf(size.x, size.y), size.z);
    box_init(&box, size, dictionary, retrace);
    for (int i = 0; i < LIGHTS; i++) {
        vec3s light;
        for (int a = 0; a < 3; a++)
            light.raw[a] = (box.half.raw[a] - near) * (2.0f * rng_float(&rng) - 1.0f);
        compare_light(&box, light, &sums);
    }
    if (retrace && size.x == size.y) CHECK(box.level.retraces.count == 0);
    box_finish(&box);
    return sqrt(sums.difference / sums.all);
}

TEST(traced_again_light_of_a_long_block_is_nearer_to_rays)
{
    struct mrt_dictionary_options options = mrt_fixture_options();
    struct mrt_dictionary dictionary;
    options.texels = TEXELS;
    options.rays = 4096;
    options.lightfield_rounds = 0;
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, &dictionary));
    bake_destroy(bake);
    const float lengths[] = { 1, 2, 4 };
    double stretch[3], retrace[3];
    for (int i = 0; i < 3; i++) {
        const vec3s size = vec3_of(3.0f * lengths[i], 3.0f, 3.0f);
        stretch[i] = error_of(size, &dictionary, false);
        retrace[i] = error_of(size, &dictionary, true);
        print_message("%g : 1: error %.3f stretched, %.3f traced again\n", (double)lengths[i],
                      stretch[i], retrace[i]);
    }
    CHECK_NEAR(stretch[0], retrace[0], 0.0); // a cube keeps the dictionary's bases
    for (int i = 1; i < 3; i++) CHECK(retrace[i] < 0.7 * stretch[i]);
    mrt_dictionary_finish(test_host(), &dictionary);
}

// Blocks of equal proportions share their bases; turned ones have the same operators in the frame
// of the cube.
TEST(blocks_of_equal_proportions_share_bases)
{
    struct mrt_dictionary_options options = mrt_fixture_options();
    struct mrt_dictionary dictionary;
    struct mrt_block_map map;
    struct mrt_level level;
    options.texels = 4;
    options.rays = 256;
    options.lightfield_rounds = 0;
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, &dictionary));
    bake_destroy(bake);
    const vec3s sizes[] = { vec3_of(2, 1, 1), vec3_of(4, 2, 2), vec3_of(1, 2, 1),
                            vec3_of(3, 3, 3) };
    CHECK(mrt_block_map_init(test_host(), "test", 4, &map));
    for (int b = 0; b < 4; b++) {
        char name[] = { 'a' + (char)b, 0 };
        mrt_block_init(&map.blocks[b], name, MRT_BLOCK_CUBE);
        mrt_block_set_box(&map.blocks[b], (struct box3){ vec3_of(0, 0, 0), sizes[b] });
    }
    struct mrt_level_options level_options = { .retrace = { 8, 16.0f, true } };
    CHECK(mrt_level_init(test_host(), &map, &dictionary, &level_options, &level));
    CHECK(level.retraces.count == 2);
    CHECK(level.retraces.of_block[0] == level.retraces.of_block[1]);
    CHECK(level.retraces.of_block[0] != level.retraces.of_block[2]);
    CHECK(level.retraces.of_block[3] == -1);
    mrt_level_finish(&level);
    // The proportions of most area, and none that are flat.
    level_options.retrace = (struct mrt_retrace_limits){ 1, 16.0f, true };
    CHECK(mrt_level_init(test_host(), &map, &dictionary, &level_options, &level));
    CHECK(level.retraces.count == 1);
    CHECK(level.retraces.of_block[0] == 0 && level.retraces.of_block[1] == 0);
    CHECK(level.retraces.of_block[2] == -1 && level.retraces.of_block[3] == -1);
    mrt_level_finish(&level);
    level_options.retrace = (struct mrt_retrace_limits){ 8, 1.5f, true };
    CHECK(mrt_level_init(test_host(), &map, &dictionary, &level_options, &level));
    CHECK(level.retraces.count == 0 && level.retraces.of_block[0] == -1);
    mrt_level_finish(&level);
    mrt_block_map_finish(&map);
    mrt_dictionary_finish(test_host(), &dictionary);
}
