// Volume probes: the dictionary's irradiance against rays, and where a level's probes are.
#include "framework/test.h"
#include "techniques/mrt/mrt_fixture.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/interface.h"
#include "techniques/mrt/dictionary/prior.h"
#include "techniques/mrt/level/probes.h"
#include "techniques/mrt/level/operators.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RESOLUTION = 16, LIGHTS = 40, NORMALS = 8, K_B = 32, P = 4, PROBES = P * P * P };

// ---- U_bvol against rays

static mat3s frame_of(vec3s normal)
{
    mat3s frame = { .col = { [2] = normal } };
    basis_of(normal, &frame.col[0], &frame.col[1]);
    return frame;
}

static void light_texels(const struct mrt_shape *cube, uint32_t light, float *radiosity)
{
    struct rng rng = rng_for(light, 3, 0);
    vec3s at;
    for (int a = 0; a < 3; a++) at.raw[a] = 0.8f * rng_float(&rng) - 0.4f;
    for (int t = 0; t < mrt_shape_texels(cube); t++)
        radiosity[t] = mrt_point_light(mrt_shape_texel(cube, t), at);
}

// Irradiance of a probe for a normal, from nine coefficients.
static double of_coefficients(const float *sh, vec3s normal)
{
    return (double)sh_dot(3, sh, normal);
}

static double of_rays(const struct mrt_shape *cube, struct mrt_point at, const float *radiosity,
                      float *row)
{
    double sum = 0.0;
    memset(row, 0, (size_t)mrt_shape_texels(cube) * sizeof *row);
    mrt_gather(cube, at, mrt_fixture_rays(RESOLUTION, MRT_IRRADIANCE), row,
               (size_t)mrt_shape_texels(cube));
    for (int t = 0; t < mrt_shape_texels(cube); t++) sum += (double)(row[t] * radiosity[t]);
    return sum;
}

static double dot_row(const struct matrix_f32 *m, size_t row, const float *x)
{
    double sum = 0.0;
    for (size_t c = 0; c < m->columns; c++) sum += (double)(m->at[row * m->stride + c] * x[c]);
    return sum;
}

// L_imp T_d→b l_d: what U_bvol gathers.
static void reduce(const struct mrt_transfer *t, const float *radiosity, float *out)
{
    double b[K_B] = { 0 };
    for (size_t k = 0; k < K_B; k++)
        for (size_t i = 0; i < t->t_db.columns; i++)
            b[k] += t->t_db.at[k * t->t_db.stride + i] * (double)radiosity[i];
    for (size_t i = 0; i < t->l_imp.rows; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < K_B; k++) sum += t->l_imp.at[i * t->l_imp.stride + k] * b[k];
        out[i] = (float)sum;
    }
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Relative L2 errors of one light over some probes and normals: of nine coefficients, and of these
// in the reduced basis.
static void probe_errors(const struct mrt_shape *cube, const struct mrt_transfer *transfer,
                         uint32_t light, double *sh_error, double *reduced_error)
{
    const struct matrix_f32 *gather = &mrt_fixture_cube(RESOLUTION)->by_measure[MRT_PROBE];
    const size_t texels = (size_t)mrt_shape_texels(cube);
    float *radiosity = malloc(texels * sizeof *radiosity), *row = malloc(texels * sizeof *row);
    float *reduced = malloc(texels * sizeof *reduced);
    double all = 0.0, sh_sum = 0.0, reduced_sum = 0.0;
    light_texels(cube, light, radiosity);
    reduce(transfer, radiosity, reduced);
    for (int i = 0; i < NORMALS; i++) {
        struct rng rng = rng_for(light, 4, (uint32_t)i);
        int probe = (int)(rng_u32(&rng) % PROBES);
        vec3s normal = sample_sphere((vec2s){ { rng_float(&rng), rng_float(&rng) } });
        float exact[9], approximate[9];
        for (size_t k = 0; k < 9; k++) {
            exact[k] = (float)dot_row(gather, 9 * (size_t)probe + k, radiosity);
            approximate[k] = (float)dot_row(gather, 9 * (size_t)probe + k, reduced);
        }
        struct mrt_point at = mrt_gather_point(cube, P, MRT_PROBE, probe);
        at.frame = frame_of(normal);
        double e = of_rays(cube, at, radiosity, row);
        all += e * e;
        sh_sum += pow(of_coefficients(exact, normal) - e, 2.0);
        reduced_sum += pow(of_coefficients(approximate, normal) - e, 2.0);
    }
    *sh_error = sqrt(sh_sum / all);
    *reduced_error = sqrt(reduced_sum / all);
    free(radiosity);
    free(row);
    free(reduced);
}

TEST(mrt_probes_have_the_irradiance_of_rays)
{
    const struct mrt_shape cube = mrt_cube(RESOLUTION, 0);
    struct matrix_f64 f;
    struct mrt_transfer transfer;
    double sh[LIGHTS], reduced[LIGHTS];
    mrt_fixture_transfer(&cube, K_B, true, &f, &transfer);
    for (uint32_t l = 0; l < LIGHTS; l++) probe_errors(&cube, &transfer, l, &sh[l], &reduced[l]);
    qsort(sh, LIGHTS, sizeof *sh, ascending);
    qsort(reduced, LIGHTS, sizeof *reduced, ascending);
    print_message("error of %d lights, median and worst: nine coefficients %.3f %.3f, with %d "
                  "modes %.3f %.3f\n",
                  LIGHTS, sh[LIGHTS / 2], sh[LIGHTS - 1], K_B, reduced[LIGHTS / 2],
                  reduced[LIGHTS - 1]);
    CHECK(sh[LIGHTS / 2] < 0.02 && sh[LIGHTS - 1] < 0.06);
    CHECK(reduced[LIGHTS / 2] < 0.11 && reduced[LIGHTS - 1] < 0.42);
    mrt_transfer_finish(test_host(), &transfer);
    matrix_f64_finish(test_host(), &f);
}

// ---- turned operators

TEST(mrt_turned_probes_are_the_turned_function)
{
    struct matrix_f32 from, to;
    struct rng rng = rng_for(1, 2, 3);
    CHECK(matrix_f32_init(test_host(), &from, 9 * PROBES, 1));
    for (size_t i = 0; i < from.rows; i++) from.at[i] = rng_float(&rng) - 0.5f;
    for (int face = 0; face < CUBE_FACES; face++) {
        mat3s turn = mrt_block_from_entry(face);
        const struct mrt_shape closed = mrt_cube(4, 0);
        const struct mrt_rotation how = { closed, closed, turn };
        CHECK(mrt_rotate_light(test_host(), &how, P, MRT_PROBE, &from, &to));
        for (int i = 0; i < PROBES; i++) {
            vec3s cell = glms_mat3_mulv(turn, mrt_probe_cell(P, i)),
                  direction = vec3_of(.6f, 0, .8f);
            int there = -1;
            for (int k = 0; k < PROBES; k++)
                if (glms_vec3_distance(mrt_probe_cell(P, k), cell) < 1e-4f) there = k;
            CHECK(there >= 0);
            CHECK_NEAR(sh_dot(3, to.at + 9 * there, glms_mat3_mulv(turn, direction)),
                       sh_dot(3, from.at + 9 * i, direction), 1e-5);
        }
        matrix_f32_finish(test_host(), &to);
    }
    matrix_f32_finish(test_host(), &from);
}

TEST(mrt_rotation_of_a_block_has_its_axes)
{
    struct mrt_block block;
    mrt_block_init(&block, "box", MRT_BLOCK_CUBE);
    mrt_block_set_box(&block, (struct box3){ vec3_of(0, 0, 0), vec3_of(8, 2, 0.5f) });
    for (int i = 0; i < MRT_ORIENTATIONS; i++) {
        struct mrt_block turned = block;
        mrt_turn_block(&turned, i);
        mat3s q = mrt_block_rotation(&turned);
        mat3s j = mrt_warp_jacobian(turned.corner, vec3_of(0, 0, 0));
        CHECK_NEAR(glms_mat3_det(q), 1.0f, 1e-4);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR(glms_vec3_distance(q.col[c], vec3_unit(j.col[c])), 0.0f, 1e-4);
    }
}

// ---- borders of bricks

static vec3s probe_place(const struct mrt_block_map *map, int probe)
{
    return mrt_probe_position(&map->blocks[probe / PROBES], P, probe % PROBES);
}

// The side by which exactly one coordinate of a brick's texel is outside; −1: another number.
static int side_of(int texel, vec3s *cell)
{
    const int edge = P + 2, at[3] = { texel % edge, texel / edge % edge, texel / (edge * edge) };
    int face = -1, outside = 0;
    for (int a = 0; a < 3; a++) {
        cell->raw[a] = ((float)at[a] - 0.5f) / P - 0.5f;
        if (at[a] > 0 && at[a] <= P) continue;
        outside++;
        face = 2 * a + (at[a] > 0);
    }
    return outside == 1 ? face : -1;
}

// Unit cubes: the neighbour's probes continue those of the block.
TEST(mrt_bricks_continue_through_openings_and_end_at_walls)
{
    struct mrt_block_map map = mrt_random_grid(4, 4, 0.6f, true, 9);
    int through = 0, at_walls = 0;
    for (int i = 0; i < map.count * mrt_brick_texels(P); i++) {
        const int block = i / mrt_brick_texels(P);
        vec3s cell;
        int probe = mrt_probe_of_brick_texel(&map, P, block, i % mrt_brick_texels(P));
        int face = side_of(i % mrt_brick_texels(P), &cell);
        if (face < 0) continue;
        vec3s world = mrt_warp_point(map.blocks[block].corner, cell);
        float distance = glms_vec3_distance(probe_place(&map, probe), world);
        if (map.blocks[block].neighbor[face].block >= 0) {
            CHECK(probe / PROBES == map.blocks[block].neighbor[face].block);
            CHECK_NEAR(distance, 0.0f, 1e-4);
            through++;
        } else {
            CHECK(probe / PROBES == block);
            CHECK_NEAR(distance, 1.0f / P, 1e-4);
            at_walls++;
        }
    }
    CHECK(through > 100 && at_walls > 100);
    mrt_block_map_finish(&map);
}
