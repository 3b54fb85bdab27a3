// T_b→r of levels: paths, orientations, what the dictionary lacks, times.
#include "framework/test.h"
#include "techniques/mrt/mrt_map_fixture.h"
#include "techniques/mrt/mrt_operators_fixture.h"

#include "core/parallel.h"
#include "techniques/mrt/level/solver.h"

#include <math.h>
#include <string.h>
#include <time.h>

// Processor time of this thread, to which other load adds little.
static double thread_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static struct mrt_level make(const struct mrt_block_map *map, const struct mrt_dictionary *o,
                             int depth)
{
    struct mrt_level level;
    struct mrt_level_options options = { .max_depth = depth };
    if (!mrt_level_init(test_host(), map, o, &options, &level)) fail_msg("%s", test_last_message());
    return level;
}

// ---- paths

enum { K_B = 2, K_RLF = 3, K_R = 2 };

// The sum over all paths, one by one, in a plan whose cells have the axes of the world.
struct brute {
    const struct mrt_level *level;
    int target, max_depth; // entry
    double sum[K_R * K_B];
};

static void product(const struct matrix_f32 *a, const double *x, double *out)
{
    for (size_t r = 0; r < a->rows; r++)
        for (size_t c = 0; c < K_B; c++) {
            out[r * K_B + c] = 0.0;
            for (size_t k = 0; k < a->columns; k++)
                out[r * K_B + c] += (double)a->at[r * a->stride + k] * x[k * K_B + c];
        }
}

static void follow(struct brute *brute, int block, int entry_face, unsigned taken, int depth,
                   const double *light)
{
    const struct mrt_level *level = brute->level;
    const struct mrt_block *at = &level->map->blocks[block];
    if (level->entry_of_face[CUBE_FACES * block + entry_face] == brute->target) {
        double response[K_R * K_B];
        product(&level->dictionary->entered[0].t_r, light, response);
        for (int i = 0; i < K_R * K_B; i++) brute->sum[i] += response[i];
    }
    for (int f = 0; f < CUBE_FACES && depth < brute->max_depth; f++) {
        if (f == entry_face || at->neighbor[f].block < 0) continue;
        if (taken >> cube_opposite(f) & 1u) continue; // never back
        double next[K_RLF * K_B];
        struct mrt_passage passage = mrt_passage_between(entry_face, f);
        CHECK(passage.rolls == 0);
        product(&level->dictionary->r_turn[passage.turn], light, next);
        follow(brute, at->neighbor[f].block, at->neighbor[f].face, taken | 1u << f, depth + 1,
               next);
    }
}

static void brute_force(struct brute *brute, int source)
{
    const struct mrt_level *level = brute->level;
    const struct mrt_cube_place *place = &level->place[source];
    memset(brute->sum, 0, sizeof brute->sum);
    for (int f = 0; f < CUBE_FACES; f++) {
        const struct mrt_neighbor *n = &level->map->blocks[source].neighbor[f];
        if (n->block < 0) continue;
        int face = mrt_rotated_face(glms_mat3_transpose(place->block_from_cube), f);
        const struct matrix_f32 *r_b = &level->dictionary->element[place->cube].r_b[face];
        double light[K_RLF * K_B];
        for (int i = 0; i < K_RLF * K_B; i++) light[i] = (double)r_b->at[i];
        follow(brute, n->block, n->face, 1u << f, 1, light);
    }
}

// The matrix of a link, or zeros.
static const float *link_of(const struct mrt_level *level, int entry, int source)
{
    static const float none[MRT_LANES * K_B];
    for (int l = level->first_link[entry]; l < level->first_link[entry + 1]; l++)
        if (level->links[l].source == source) return level->matrices + level->links[l].matrix;
    return none;
}

TEST(the_operator_is_the_sum_over_all_paths)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 2, K_B, K_RLF, K_R, 1);
    for (uint32_t i = 0; i < 4; i++) {
        struct mrt_block_map map = mrt_random_grid(3, 3, i ? 0.7f : 1.0f, false, i);
        struct mrt_level level = make(&map, &o, 5);
        for (int entry = 0; entry < level.entry_count; entry++)
            for (int source = 0; source < map.count; source++) {
                struct brute brute = { .level = &level, .target = entry, .max_depth = 5 };
                brute_force(&brute, source);
                const float *link = link_of(&level, entry, source);
                for (int r = 0; r < K_R; r++)
                    for (int c = 0; c < K_B; c++)
                        CHECK_NEAR(link[c * level.link_stride + r], brute.sum[r * K_B + c], 1e-5);
            }
        mrt_level_finish(&level);
        mrt_block_map_finish(&map);
    }
    mrt_dictionary_finish(test_host(), &o);
}

TEST(light_does_not_return_to_its_block)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 2, K_B, K_RLF, K_R, 2);
    struct mrt_block_map map = mrt_random_grid(3, 3, 1.0f, false, 0);
    struct mrt_level level = make(&map, &o, 20);
    for (int e = 0; e < level.entry_count; e++)
        for (int l = level.first_link[e]; l < level.first_link[e + 1]; l++) {
            CHECK(level.links[l].source != level.entries[e].block);
            CHECK(l == level.first_link[e] || level.links[l].source > level.links[l - 1].source);
        }
    mrt_level_finish(&level);
    mrt_block_map_finish(&map);
    mrt_dictionary_finish(test_host(), &o);
}

TEST(light_goes_no_farther_than_the_depth)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 2, K_B, K_RLF, K_R, 3);
    struct mrt_block_map map = mrt_random_grid(6, 1, 1.0f, false, 0);
    for (int depth = 0; depth < 6; depth++) {
        struct mrt_level level = make(&map, &o, depth);
        int expected = 0; // pairs of blocks of a chain
        for (int d = 1; d <= depth; d++) expected += 2 * (6 - d);
        CHECK(level.entry_count == 10 && level.first_link[10] == expected);
        mrt_level_finish(&level);
    }
    mrt_block_map_finish(&map);
    mrt_dictionary_finish(test_host(), &o);
}

TEST(blocks_that_the_dictionary_lacks_are_refused_by_name)
{
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 2, K_B, K_RLF, K_R, 4);
    struct mrt_block_map map = mrt_random_grid(2, 1, 1.0f, false, 0);
    struct mrt_level level;
    struct mrt_level_options options = { .max_depth = 2 };
    map.blocks[1].open |= 1u << CUBE_TOP;
    CHECK(!mrt_level_init(test_host(), &map, &o, &options, &level));
    CHECK(strstr(test_last_message(), "cube 1"));
    map.blocks[1].open &= ~(1u << CUBE_TOP);
    for (uint32_t seed = 0; seed < 20; seed++) { // turned: some are tilted, none crashes
        struct mrt_block_map turned = mrt_random_grid(2, 1, 1.0f, true, seed);
        if (mrt_level_init(test_host(), &turned, &o, &options, &level)) mrt_level_finish(&level);
        mrt_block_map_finish(&turned);
    }
    mrt_block_map_finish(&map);
    mrt_dictionary_finish(test_host(), &o);
}

TEST(a_maze_is_plane_and_a_map_with_openings_above_is_not)
{
    for (uint32_t seed = 0; seed < 20; seed++) {
        struct mrt_block_map map = mrt_random_grid(4, 3, 0.8f, true, seed);
        struct mrt_block_map maze = mrt_maze(11, seed);
        CHECK(!mrt_block_map_is_plane(&map) && mrt_block_map_is_plane(&maze));
        mrt_block_map_finish(&map);
        mrt_block_map_finish(&maze);
    }
}

// ---- orientations

struct lit {
    struct mrt_block_map map;
    struct mrt_atlas atlas;
    float *irradiance;
};

static vec3s texel_place(const struct lit *lit, int texel, vec3s *normal)
{
    int n = lit->atlas.resolution;
    const struct mrt_tile *tile = &lit->atlas.tiles[texel / (n * n)];
    vec3s p = cube_face_point(tile->face, ((float)(texel % n) + 0.5f) / (float)n,
                              ((float)(texel / n % n) + 0.5f) / (float)n);
    const vec3s *corner = lit->map.blocks[tile->block].corner;
    *normal = glms_vec3_negate(mrt_warp_face_normal(corner, tile->face, p));
    return mrt_warp_point(corner, p);
}

// Light at the texels of block 0.
static struct lit light_grid(const struct mrt_dictionary *o, bool turned, uint32_t seed)
{
    struct lit lit = { .map = mrt_random_grid(3, 3, 0.8f, turned, seed) };
    struct mrt_level level = make(&lit.map, o, 5);
    struct mrt_solver solver;
    CHECK(mrt_atlas_init(test_host(), &lit.map, o->options.texels, &lit.atlas));
    CHECK(mrt_solver_init(test_host(), &level, &solver));
    size_t texels = (size_t)lit.atlas.texels;
    float *light = host_alloc(test_host(), 3 * texels, sizeof *light);
    lit.irradiance = host_alloc(test_host(), 3 * texels, sizeof *lit.irradiance);
    CHECK(light && lit.irradiance);
    for (int t = 0; t < level.first_texel[1]; t++) {
        vec3s normal, p = texel_place(&lit, t, &normal);
        vec3s to = glms_vec3_sub(vec3_of(0.3f, 0.4f, 0.6f), p);
        float d2 = glms_vec3_norm2(to);
        for (int c = 0; c < 3; c++)
            light[3 * t + c] = (float)(c + 1) * glms_vec3_dot(to, normal) / (d2 * sqrtf(d2));
    }
    mrt_solve(&solver, light, lit.irradiance);
    host_free(test_host(), light);
    mrt_solver_finish(&solver);
    mrt_level_finish(&level);
    return lit;
}

static void finish_lit(struct lit *lit)
{
    host_free(test_host(), lit->irradiance);
    mrt_atlas_finish(&lit->atlas);
    mrt_block_map_finish(&lit->map);
}

static int same_place(const struct lit *lit, vec3s p, vec3s normal)
{
    for (int t = 0; t < lit->atlas.texels; t++) {
        vec3s n, q = texel_place(lit, t, &n);
        if (glms_vec3_distance(p, q) < 1e-3f && glms_vec3_dot(n, normal) > 0.9f) return t;
    }
    return -1;
}

// Rays are not symmetric: a few percent. A wrong turn of an interface costs far more.
TEST(blocks_may_be_turned_in_any_way)
{
    struct mrt_dictionary o = mrt_unreduced_operators();
    for (uint32_t seed = 0; seed < 2; seed++) {
        struct lit straight = light_grid(&o, false, seed), turned = light_grid(&o, true, seed);
        double difference = 0.0, all = 0.0;
        CHECK(straight.atlas.texels == turned.atlas.texels);
        for (int t = 0; t < straight.atlas.texels; t++) {
            vec3s n, p = texel_place(&straight, t, &n);
            int other = same_place(&turned, p, n);
            CHECK(other >= 0);
            for (int c = 0; c < 3; c++) {
                double a = (double)straight.irradiance[3 * t + c];
                double b = (double)turned.irradiance[3 * other + c];
                difference += (a - b) * (a - b);
                all += a * a;
            }
        }
        print_message("turned blocks: relative difference %.4f\n", sqrt(difference / all));
        CHECK(all > 0.0 && sqrt(difference / all) < 0.03);
        finish_lit(&straight);
        finish_lit(&turned);
    }
    mrt_dictionary_finish(test_host(), &o);
}

// ---- times

TEST(a_level_of_41_blocks_takes_less_than_a_second_on_one_core)
{
    const int threads = parallel_threads();
    parallel_limit(1);
    struct mrt_dictionary o = mrt_random_operators(MRT_MAZE_2D, 16, 32, 128, 32, 5);
    struct mrt_block_map map = mrt_maze(41, 1);
    for (int depth = 2; depth <= 16; depth *= 2) {
        double start = thread_s();
        struct mrt_level level = make(&map, &o, depth);
        double seconds = thread_s() - start;
        print_message("41 blocks, depth %d: %d entries, %d links, %.0f ms\n", depth,
                      level.entry_count, level.first_link[level.entry_count], 1e3 * seconds);
        CHECK(seconds < 1.0);
        mrt_level_finish(&level);
    }
    parallel_limit(threads);
    mrt_block_map_finish(&map);
    mrt_dictionary_finish(test_host(), &o);
}
