// solver=cpu against plain sums, its laws and its times.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"
#include "techniques/mrt/mrt_operators_fixture.h"

#include "core/rng.h"

#include "techniques/mrt/level/solver.h"

#include <math.h>
#include <string.h>
#include <time.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

struct level_of_maze {
    struct mrt_block_map map;
    struct mrt_level level;
    struct mrt_solver solver;
    size_t values; // of light: 3 for each texel
    float *light, *out;
};

static void make(const struct mrt_dictionary *o, int blocks, int seed, struct level_of_maze *m)
{
    const bool tunnel = o->options.maze == MRT_TUNNEL;
    struct mrt_level_options options = { .max_depth = 6 };
    struct rng rng = rng_for((uint32_t)seed, 9, 9);
    m->map = tunnel ? mrt_tunnel(blocks, seed) : mrt_maze(blocks, seed);
    CHECK(mrt_level_init(test_host(), &m->map, o, &options, &m->level));
    CHECK(mrt_solver_init(test_host(), &m->level, &m->solver));
    m->values = 3 * (size_t)m->level.first_texel[blocks];
    m->light = host_alloc(test_host(), m->values, sizeof *m->light);
    m->out = host_alloc(test_host(), m->values, sizeof *m->out);
    CHECK(m->light && m->out);
    for (size_t i = 0; i < m->values; i++) m->light[i] = rng_float(&rng);
}

static void finish(struct level_of_maze *m)
{
    host_free(test_host(), m->light);
    host_free(test_host(), m->out);
    mrt_solver_finish(&m->solver);
    mrt_level_finish(&m->level);
    mrt_block_map_finish(&m->map);
}

// ---- plain sums

// b of one block, one colour.
static void plain_b(const struct level_of_maze *m, int block, int colour, double *b)
{
    const struct mrt_level *level = &m->level;
    const struct mrt_cube_place *place = &level->place[block];
    struct mrt_shape cell = mrt_level_cell(level, block);
    struct mrt_shape cube =
        mrt_dictionary_shape(level->maze, level->dictionary->options.texels, place->cube);
    const struct matrix_f32 *t_db = &level->dictionary->element[place->cube].t_db;
    for (int k = 0; k < level->k_b; k++) b[k] = 0.0;
    for (int t = 0; t < mrt_shape_texels(&cell); t++) {
        int texel = mrt_rotated_texel(&cube, place->block_from_cube, &cell, t);
        for (int k = 0; k < level->k_b; k++)
            b[k] += (double)t_db->at[(size_t)k * t_db->stride + (size_t)texel] *
                    (double)m->light[3 * (level->first_texel[block] + t) + colour];
    }
}

enum { MAX_K = 32 };

static void plain_r(const struct level_of_maze *m, int entry, int colour, double *r)
{
    const struct mrt_level *level = &m->level;
    int k_b = level->k_b, k_r = level->k_r;
    double b[MAX_K];
    for (int k = 0; k < k_r; k++) r[k] = 0.0;
    for (int l = level->first_link[entry]; l < level->first_link[entry + 1]; l++) {
        plain_b(m, level->links[l].source, colour, b);
        const float *matrix = level->matrices + level->links[l].matrix;
        for (int i = 0; i < k_b; i++)
            for (int k = 0; k < k_r; k++) r[k] += (double)matrix[i * level->link_stride + k] * b[i];
    }
}

static double row_times(const struct matrix_f32 *m, int row, const double *x)
{
    double sum = 0.0;
    for (size_t k = 0; k < m->columns; k++)
        sum += (double)m->at[(size_t)row * m->stride + k] * x[k];
    return sum;
}

static void check_block(const struct level_of_maze *m, int block, int colour)
{
    const struct mrt_level *level = &m->level;
    const struct mrt_cube_place *place = &level->place[block];
    const int texels = level->dictionary->options.texels;
    struct mrt_shape cell = mrt_level_cell(level, block);
    struct mrt_shape cube = mrt_dictionary_shape(level->maze, texels, place->cube);
    double b[MAX_K], r[CUBE_FACES][MAX_K];
    plain_b(m, block, colour, b);
    for (int f = 0; f < CUBE_FACES; f++)
        if (m->map.blocks[block].neighbor[f].block >= 0)
            plain_r(m, level->entry_of_face[CUBE_FACES * block + f], colour, r[f]);
    for (int t = 0; t < mrt_shape_texels(&cell); t++) {
        double sum = row_times(&level->dictionary->element[place->cube].u_b,
                               mrt_rotated_texel(&cube, place->block_from_cube, &cell, t), b);
        for (int f = 0; f < CUBE_FACES; f++) {
            if (m->map.blocks[block].neighbor[f].block < 0) continue;
            const int by = mrt_entered_by(&cell, f);
            const struct mrt_shape entered = mrt_entered_shape(level->maze, texels, by);
            sum += row_times(&level->dictionary->entered[by].u_r,
                             mrt_rotated_texel(&entered, mrt_block_from_entry(f), &cell, t), r[f]);
        }
        CHECK_NEAR(m->out[3 * (level->first_texel[block] + t) + colour], sum,
                   1e-4 * (1.0 + fabs(sum)));
    }
}

TEST(the_solver_gives_the_sums_of_the_paper)
{
    static const int resolutions[] = { 3, 4, 6 };
    for (int i = 0; i < 3; i++) {
        struct mrt_dictionary o =
            mrt_random_operators(MRT_MAZE_2D, resolutions[i], 7 + 5 * i, 16, 5 + 8 * i, 1);
        struct level_of_maze m;
        make(&o, 12, 3 + i, &m);
        mrt_solve(&m.solver, m.light, m.out);
        for (int block = 0; block < 12; block++)
            for (int c = 0; c < 3; c++) check_block(&m, block, c);
        finish(&m);
        mrt_dictionary_finish(test_host(), &o);
    }
}

TEST(the_solver_gives_the_sums_of_the_paper_in_tubes)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_TUNNEL, 2, 7, 16, 5, 1);
    for (int seed = 1; seed < 4; seed++) {
        struct level_of_maze m;
        make(&o, 12, seed, &m);
        mrt_solve(&m.solver, m.light, m.out);
        for (int block = 0; block < 12; block++)
            for (int c = 0; c < 3; c++) check_block(&m, block, c);
        finish(&m);
    }
    mrt_dictionary_finish(test_host(), &o);
}

// ---- laws

TEST(twice_the_light_gives_twice_the_result_and_no_light_is_black)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 16, 32, 64, 32, 2);
    struct level_of_maze m;
    make(&o, 11, 1, &m);
    float *once = host_alloc(test_host(), m.values, sizeof *once);
    CHECK(once);
    mrt_solve(&m.solver, m.light, once);
    for (size_t i = 0; i < m.values; i++) m.light[i] *= 2.0f;
    mrt_solve(&m.solver, m.light, m.out);
    for (size_t i = 0; i < m.values; i++) CHECK(m.out[i] == 2.0f * once[i]);
    memset(m.light, 0, m.values * sizeof *m.light);
    mrt_solve(&m.solver, m.light, m.out);
    for (size_t i = 0; i < m.values; i++) CHECK(m.out[i] == 0.0f);
    host_free(test_host(), once);
    finish(&m);
    mrt_dictionary_finish(test_host(), &o);
}

TEST(frames_are_equal_to_the_bit)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 8, 32, 64, 32, 2);
    struct level_of_maze m;
    make(&o, 30, 1, &m);
    float *first = host_alloc(test_host(), m.values, sizeof *first);
    CHECK(first);
    mrt_solve(&m.solver, m.light, first);
    for (int i = 0; i < 20; i++) {
        mrt_solve(&m.solver, m.light, m.out);
        CHECK(memcmp(first, m.out, m.values * sizeof *first) == 0);
    }
    host_free(test_host(), first);
    finish(&m);
    mrt_dictionary_finish(test_host(), &o);
}

// ---- times

static double best_ms(struct level_of_maze *m, int runs)
{
    double best = INFINITY;
    for (int i = 0; i < runs; i++) {
        double start = now_s();
        mrt_solve(&m->solver, m->light, m->out);
        best = fmin(best, 1e3 * (now_s() - start));
    }
    return best;
}

// Coefficient of determination of the least-squares line.
static double r_squared(const double *x, const double *y, int n)
{
    double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
    for (int i = 0; i < n; i++) {
        sx += x[i];
        sy += y[i];
        sxx += x[i] * x[i];
        sxy += x[i] * y[i];
        syy += y[i] * y[i];
    }
    double covariance = n * sxy - sx * sy;
    return covariance * covariance / ((n * sxx - sx * sx) * (n * syy - sy * sy));
}

TEST(work_is_linear_in_the_number_of_blocks)
{
    enum { MAZES = 20 };
    double blocks[MAZES], work[MAZES], time[MAZES];
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 16, 32, 32, 32, 4);
    for (int i = 0; i < MAZES; i++) {
        struct level_of_maze m;
        make(&o, 5 + 5 * i, 1 + i, &m);
        const struct mrt_level *level = &m.level;
        // Multiplications for one colour.
        blocks[i] = (double)m.map.count;
        work[i] = 64.0 * (double)m.values / 3.0 + 32.0 * 1024.0 * (double)level->entry_count +
                  1024.0 * (double)level->first_link[level->entry_count];
        time[i] = best_ms(&m, 15);
        print_message("%d blocks, %d links: %.2f ms\n", m.map.count,
                      level->first_link[level->entry_count], time[i]);
        finish(&m);
    }
    print_message("5 to 100 blocks: R2 of the work %.4f, of the time %.4f; 100 blocks: %.2f ms\n",
                  r_squared(blocks, work, MAZES), r_squared(blocks, time, MAZES), time[MAZES - 1]);
    CHECK(r_squared(blocks, work, MAZES) > 0.98);
    mrt_dictionary_finish(test_host(), &o);
}

// Table 3.3: 16 × 16 texels, 32 modes. Times are printed alone: other programs run beside tests.
TEST(mazes_of_11_and_41_blocks_take_this_long)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 16, 32, 128, 32, 4);
    for (int blocks = 11; blocks <= 41; blocks += 30) {
        struct level_of_maze m;
        make(&o, blocks, 1, &m);
        print_message("%d blocks: %.2f ms\n", blocks, best_ms(&m, 50));
        finish(&m);
    }
    mrt_dictionary_finish(test_host(), &o);
}
