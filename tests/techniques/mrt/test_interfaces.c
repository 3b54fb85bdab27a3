// Light through the interfaces of connected blocks, against rays through the joined geometry.
#include "framework/test.h"
#include "techniques/mrt/mrt_bake_fixture.h"

#include "core/rng.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/prior.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RESOLUTION = 16, MAX_BLOCKS = 5, LIGHTS = 8 };

// A chain of blocks: each lies beyond face exit[i] of the one before.
struct chain {
    const char *name;
    int blocks;
    int exit[MAX_BLOCKS - 1];
    double bound[MAX_BLOCKS - 1];
    double probes[MAX_BLOCKS - 1];
};

static unsigned missing_of(const struct chain *chain, int block)
{
    unsigned missing = 0;
    if (block > 0) missing |= 1u << cube_opposite(chain->exit[block - 1]);
    if (block + 1 < chain->blocks) missing |= 1u << chain->exit[block];
    return missing;
}

// Follows a ray from block `block` to a surface. True: it is of block 0, at `hit`.
static bool trace_chain(const struct chain *chain, int block, vec3s from, vec3s direction,
                        struct mrt_hit *hit)
{
    for (;;) {
        struct mrt_shape cube = mrt_cube(RESOLUTION, missing_of(chain, block));
        mrt_shape_trace(&cube, from, direction, hit);
        if (hit->opening < 0) return block == 0;
        int next = block > 0 && hit->opening == cube_opposite(chain->exit[block - 1]) ? block - 1
                                                                                      : block + 1;
        vec3s at = cube_face_point(hit->opening, hit->s, hit->t);
        from = glms_vec3_sub(at, cube_from_face(hit->opening).col[2]);
        block = next;
    }
}

// Irradiance at a texel of `block` from radiosity in block 0, for several lights.
static void gather_chain(const struct chain *chain, int block, int texel,
                         const struct mrt_rays *rays, const struct matrix_f32 *radiosity,
                         double out[LIGHTS])
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, missing_of(chain, block));
    struct mrt_point at = mrt_shape_texel(&cube, texel);
    struct mrt_hit hit;
    memset(out, 0, LIGHTS * sizeof *out);
    for (int i = 0; i < rays->count; i++) {
        vec3s ray = glms_mat3_mulv(at.frame, rays->direction[i]);
        if (!trace_chain(chain, block, at.position, ray, &hit)) continue;
        for (int l = 0; l < LIGHTS; l++)
            for (int k = 0; k < hit.texels; k++)
                out[l] +=
                    (double)(rays->weight[i] * hit.weight[k] *
                             radiosity->at[(size_t)l * radiosity->stride + (size_t)hit.texel[k]]);
    }
}

// SH coefficients of irradiance by normal at a point of `block`, in the frame of the point.
static void gather_probe(const struct chain *chain, int block, struct mrt_point at,
                         const struct mrt_rays *rays, const struct matrix_f32 *radiosity,
                         double out[9][LIGHTS])
{
    struct mrt_hit hit;
    memset(out, 0, 9 * sizeof *out);
    for (int i = 0; i < rays->count; i++) {
        vec3s ray = glms_mat3_mulv(at.frame, rays->direction[i]);
        if (!trace_chain(chain, block, at.position, ray, &hit)) continue;
        for (int l = 0; l < LIGHTS; l++) {
            double sum = 0.0;
            for (int k = 0; k < hit.texels; k++)
                sum +=
                    (double)(hit.weight[k] *
                             radiosity->at[(size_t)l * radiosity->stride + (size_t)hit.texel[k]]);
            for (int q = 0; q < 9; q++) out[q][l] += (double)rays->weight[9 * i + q] * sum;
        }
    }
}

// Rows: lights; columns: texels of block 0.
static struct matrix_f32 light_block(const struct chain *chain)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, missing_of(chain, 0));
    struct matrix_f32 out;
    CHECK(matrix_f32_init(test_host(), &out, LIGHTS, (size_t)mrt_shape_texels(&cube)));
    for (uint32_t l = 0; l < LIGHTS; l++) {
        struct rng rng = rng_for(l, 1, 7);
        vec3s at;
        for (int a = 0; a < 3; a++) at.raw[a] = 0.8f * rng_float(&rng) - 0.4f;
        for (size_t t = 0; t < out.columns; t++)
            out.at[l * out.stride + t] = mrt_point_light(mrt_shape_texel(&cube, (int)t), at);
    }
    return out;
}

static void multiply(const struct matrix_f32 *a, const struct matrix_f32 *b, struct matrix_f32 *out)
{
    CHECK(matrix_f32_init(test_host(), out, a->rows, b->columns));
    CHECK(matrix_f32_multiply(test_host(), 1.0f, a, NOT_TRANSPOSED, b, NOT_TRANSPOSED, 0.0f, out));
}

// Lightfield coefficients (k_rlf × lights) at the exit of block 0.
static struct matrix_f32 leave_block(const struct mrt_dictionary *x, const struct chain *chain,
                                     const struct matrix_f32 *radiosity)
{
    struct mrt_cube_place place;
    struct mrt_shape block = mrt_cube(RESOLUTION, missing_of(chain, 0));
    CHECK(mrt_cube_find((enum mrt_maze)x->options.maze, block.missing, &place));
    struct mrt_shape cube =
        mrt_cube(RESOLUTION, mrt_cube_missing((enum mrt_maze)x->options.maze, place.cube));
    struct matrix_f32 turned, b, out;
    CHECK(matrix_f32_init(test_host(), &turned, radiosity->columns, LIGHTS));
    for (size_t t = 0; t < radiosity->columns; t++) {
        int texel = mrt_rotated_texel(&cube, place.block_from_cube, &block, (int)t);
        for (size_t l = 0; l < LIGHTS; l++)
            turned.at[(size_t)texel * LIGHTS + l] = radiosity->at[l * radiosity->stride + t];
    }
    const struct mrt_element *element = &x->element[place.cube];
    multiply(&element->t_db, &turned, &b);
    int face = mrt_rotated_face(glms_mat3_transpose(place.block_from_cube), chain->exit[0]);
    multiply(&element->r_b[face], &b, &out);
    mat3s frame = glms_mat3_mul(place.block_from_cube, cube_from_face(face));
    for (int i = mrt_rolls_between(frame, cube_from_face(chain->exit[0])); i > 0; i--) {
        struct matrix_f32 rolled;
        multiply(&x->r_turn[MRT_ROLL], &out, &rolled);
        matrix_f32_finish(test_host(), &out);
        out = rolled;
    }
    matrix_f32_finish(test_host(), &turned);
    matrix_f32_finish(test_host(), &b);
    return out;
}

static void pass_block(const struct mrt_dictionary *x, int exit_before, int exit,
                       struct matrix_f32 *light)
{
    struct mrt_passage passage = mrt_passage_between(cube_opposite(exit_before), exit);
    for (int i = 0; i <= passage.rolls; i++) {
        struct matrix_f32 next;
        multiply(&x->r_turn[i == 0 ? passage.turn : MRT_ROLL], light, &next);
        matrix_f32_finish(test_host(), light);
        *light = next;
    }
}

// Relative L2 error over the texels of `block`, per light; and the light itself.
static void block_errors(const struct mrt_dictionary *x, const struct chain *chain, int block,
                         const struct matrix_f32 *light, const struct mrt_rays *rays,
                         const struct matrix_f32 *radiosity, double errors[LIGHTS], double *mean)
{
    struct mrt_shape cube = mrt_cube(RESOLUTION, missing_of(chain, block));
    struct mrt_shape entered = mrt_entered_shape((enum mrt_maze)x->options.maze, RESOLUTION, 0);
    struct matrix_f32 r, irradiance;
    mat3s frame = mrt_block_from_entry(cube_opposite(chain->exit[block - 1]));
    double difference[LIGHTS] = { 0 }, all[LIGHTS] = { 0 }, exact[LIGHTS];
    multiply(&x->entered[0].t_r, light, &r);
    multiply(&x->entered[0].u_r, &r, &irradiance);
    *mean = 0.0;
    for (int t = 0; t < mrt_shape_texels(&cube); t += 11) {
        int texel = mrt_rotated_texel(&entered, frame, &cube, t);
        gather_chain(chain, block, t, rays, radiosity, exact);
        for (int l = 0; l < LIGHTS; l++) {
            double d = (double)irradiance.at[(size_t)texel * LIGHTS + (size_t)l] - exact[l];
            difference[l] += d * d;
            all[l] += exact[l] * exact[l];
            *mean += exact[l] / LIGHTS / (mrt_shape_texels(&cube) / 11.0);
        }
    }
    for (int l = 0; l < LIGHTS; l++) errors[l] = sqrt(difference[l] / all[l]);
    matrix_f32_finish(test_host(), &r);
    matrix_f32_finish(test_host(), &irradiance);
}

// The same over all coefficients of the probes.
static void probe_errors(const struct mrt_dictionary *x, const struct chain *chain, int block,
                         const struct matrix_f32 *light, const struct mrt_rays *rays,
                         const struct matrix_f32 *radiosity, double errors[LIGHTS])
{
    const int p = x->options.block_probes;
    struct mrt_shape entered = mrt_entered_shape((enum mrt_maze)x->options.maze, RESOLUTION, 0);
    mat3s frame = mrt_block_from_entry(cube_opposite(chain->exit[block - 1]));
    double difference[LIGHTS] = { 0 }, all[LIGHTS] = { 0 };
    struct matrix_f32 r, irradiance;
    multiply(&x->entered[0].t_r, light, &r);
    multiply(&x->entered[0].u_rvol, &r, &irradiance);
    for (int i = 0; i < p * p * p; i += 5) {
        struct mrt_point at = mrt_gather_point(&entered, p, MRT_PROBE, i);
        at = (struct mrt_point){ glms_mat3_mulv(frame, at.position), frame };
        double exact[9][LIGHTS];
        gather_probe(chain, block, at, rays, radiosity, exact);
        for (int k = 0; k < 9 * LIGHTS; k++) {
            double e = exact[k / LIGHTS][k % LIGHTS];
            size_t row = (size_t)(9 * i + k / LIGHTS);
            difference[k % LIGHTS] +=
                pow((double)irradiance.at[row * LIGHTS + (size_t)(k % LIGHTS)] - e, 2.0);
            all[k % LIGHTS] += e * e;
        }
    }
    for (int l = 0; l < LIGHTS; l++) errors[l] = sqrt(difference[l] / all[l]);
    matrix_f32_finish(test_host(), &r);
    matrix_f32_finish(test_host(), &irradiance);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void compare_chain(const struct mrt_dictionary *x, const struct chain *chain)
{
    struct mrt_rays rays, around;
    struct matrix_f32 radiosity = light_block(chain), light = leave_block(x, chain, &radiosity);
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, 16384, &rays));
    CHECK(mrt_rays_init(test_host(), MRT_PROBE, 16384, &around));
    for (int block = 1; block < chain->blocks; block++) {
        double errors[LIGHTS], mean;
        if (block > 1) pass_block(x, chain->exit[block - 2], chain->exit[block - 1], &light);
        block_errors(x, chain, block, &light, &rays, &radiosity, errors, &mean);
        qsort(errors, LIGHTS, sizeof *errors, ascending);
        print_message("%s, distance %d: irradiance %.2e, error median %.3f, worst %.3f\n",
                      chain->name, block, mean, errors[LIGHTS / 2], errors[LIGHTS - 1]);
        CHECK(errors[LIGHTS / 2] < chain->bound[block - 1]);
        probe_errors(x, chain, block, &light, &around, &radiosity, errors);
        qsort(errors, LIGHTS, sizeof *errors, ascending);
        print_message("    probes: error median %.3f, worst %.3f\n", errors[LIGHTS / 2],
                      errors[LIGHTS - 1]);
        CHECK(errors[LIGHTS / 2] < chain->probes[block - 1]);
    }
    mrt_rays_finish(test_host(), &rays);
    mrt_rays_finish(test_host(), &around);
    matrix_f32_finish(test_host(), &radiosity);
    matrix_f32_finish(test_host(), &light);
}

static void compare_chains(enum mrt_maze maze, const struct chain *chains, size_t count)
{
    struct mrt_dictionary_options options = mrt_fixture_options();
    options.maze = (int)maze;
    struct bake *bake = mrt_fixture_bake(&options, 0, false);
    struct mrt_dictionary x;
    CHECK(mrt_dictionary_init(test_host(), bake_tensors(bake), &options, &x));
    for (size_t i = 0; i < count; i++) compare_chain(&x, &chains[i]);
    mrt_dictionary_finish(test_host(), &x);
    bake_destroy(bake);
}

TEST(light_through_interfaces_is_near_that_of_the_joined_blocks)
{
    // Bounds: the median error reached, plus a tenth.
    static const struct chain chains[] = {
        { "corridor",
          5,
          { CUBE_FRONT, CUBE_FRONT, CUBE_FRONT, CUBE_FRONT },
          { 0.107, 0.113, 0.119, 0.116 },
          { 0.109, 0.116, 0.096, 0.144 } },
        { "corner",
          4,
          { CUBE_RIGHT, CUBE_FRONT, CUBE_FRONT },
          { 0.105, 0.159, 0.157 },
          { 0.138, 0.152, 0.279 } },
        { "stairs",
          4,
          { CUBE_LEFT, CUBE_BACK, CUBE_LEFT },
          { 0.103, 0.163, 0.158 },
          { 0.119, 0.140, 0.124 } },
    };
    compare_chains(MRT_MAZE_2D, chains, sizeof chains / sizeof *chains);
}

TEST(light_turns_in_space_as_in_the_plane)
{
    // Frames of exits differ from those of the dictionary by rolls.
    static const struct chain chains[] = {
        { "shaft",
          4,
          { CUBE_TOP, CUBE_TOP, CUBE_TOP },
          { 0.075, 0.107, 0.080 },
          { 0.134, 0.102, 0.153 } },
        { "spiral",
          4,
          { CUBE_TOP, CUBE_RIGHT, CUBE_BACK },
          { 0.071, 0.125, 0.322 },
          { 0.134, 0.101, 0.305 } },
        { "pit",
          4,
          { CUBE_LEFT, CUBE_BOTTOM, CUBE_FRONT },
          { 0.076, 0.141, 0.357 },
          { 0.127, 0.119, 0.246 } },
    };
    compare_chains(MRT_MAZE_3D, chains, sizeof chains / sizeof *chains);
}
