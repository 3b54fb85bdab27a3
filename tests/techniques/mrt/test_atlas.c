// The padded light map of a level: seams, creases and walls.
#include "framework/test.h"
#include "techniques/mrt/atlas_twin.h"
#include "techniques/mrt/mrt_map_fixture.h"

#include "core/rng.h"

#include "techniques/mrt/level/atlas.h"
#include "techniques/mrt/level/wall.h"

#include <math.h>
#include <string.h>

enum { RESOLUTION = 8, ALONG = 33 };

struct light_map {
    struct mrt_block_map map;
    struct mrt_atlas atlas;
    float *values, *filled;
};

static struct light_map make(struct mrt_block_map map)
{
    struct light_map m = { .map = map };
    CHECK(mrt_atlas_init(test_host(), &map, RESOLUTION, &m.atlas));
    m.values = host_alloc(test_host(), (size_t)m.atlas.texels, sizeof *m.values);
    m.filled =
        host_alloc(test_host(), (size_t)m.atlas.width * (size_t)m.atlas.height, sizeof *m.filled);
    CHECK(m.values && m.filled);
    return m;
}

static void finish(struct light_map *m)
{
    host_free(test_host(), m->values);
    host_free(test_host(), m->filled);
    mrt_atlas_finish(&m->atlas);
    mrt_block_map_finish(&m->map);
}

static void fill_random(struct light_map *m, uint32_t seed)
{
    struct rng rng = rng_for(seed, 1, 0);
    for (int i = 0; i < m->atlas.texels; i++) m->values[i] = rng_float(&rng);
    mrt_atlas_fill(&m->atlas, m->values, 1, m->filled);
}

static int tile_of(const struct light_map *m, int block, int face)
{
    return m->atlas.tile_of_face[CUBE_FACES * block + face];
}

// A point on the edge from one corner of a face to the next.
static float look_up_edge(const struct light_map *m, int tile, int from, int to, float along)
{
    static const float s[4] = { 0, 1, 1, 0 }, t[4] = { 0, 0, 1, 1 };
    vec2s at = mrt_atlas_place(&m->atlas, tile, s[from] + along * (s[to] - s[from]),
                               t[from] + along * (t[to] - t[from]));
    return mrt_atlas_look_up(&m->atlas, m->filled, 1, 0, at);
}

// The greatest difference between both sides of all seams; *seams counts them.
static float seam_error(const struct light_map *m, int *seams)
{
    float worst = 0.0f;
    *seams = 0;
    for (int t = 0; t < m->atlas.tile_count; t++) {
        const struct mrt_tile *tile = &m->atlas.tiles[t];
        for (int c = 0; c < 4; c++) {
            struct mrt_wall_corner from = { tile->block, tile->face, c }, to;
            if (!mrt_wall_continues(&m->map, from, true, &to)) continue;
            ++*seams;
            for (int i = 0; i < ALONG; i++) {
                float along = (float)i / (float)(ALONG - 1);
                float here = look_up_edge(m, t, c, (c + 1) % 4, along);
                float there = look_up_edge(m, tile_of(m, to.block, to.face), to.corner,
                                           (to.corner + 3) % 4, along);
                worst = fmaxf(worst, fabsf(here - there));
            }
        }
    }
    return worst;
}

TEST(coplanar_walls_of_connected_blocks_agree_along_their_seam)
{
    static const float chances[] = { 1.0f, 0.8f, 0.5f, 0.3f };
    for (uint32_t i = 0; i < 40; i++) {
        struct light_map m = make(mrt_random_grid(4, 3, chances[i % 4], true, i));
        int seams;
        fill_random(&m, i);
        CHECK_NEAR(seam_error(&m, &seams), 0, 1e-5);
        CHECK(seams > 0);
        if (i == 0) print_message("a grid of 4 x 3 open blocks has %d half seams\n", seams);
        // 17 openings with a floor and a ceiling, 10 beside the outer wall, from both sides.
        if (i == 0) CHECK(seams == 2 * (2 * 17 + 10));
        finish(&m);
    }
}

// ---- tubes

static float look_up(const struct light_map *m, int block, float around, float along)
{
    return mrt_atlas_look_up(&m->atlas, m->filled, 1, 0,
                             mrt_atlas_place(&m->atlas, tile_of(m, block, 0), around, along));
}

// The same point of the wall from the tubes on both sides of an end; *seams counts the ends.
static float tube_seam_error(const struct light_map *m, int *seams)
{
    float most = 0.0f;
    *seams = 0;
    for (int i = 0; i < CUBE_FACES * m->map.count; i++) {
        const int block = i / CUBE_FACES, face = i % CUBE_FACES;
        const struct mrt_block *from = &m->map.blocks[block];
        const struct mrt_neighbor *n = &from->neighbor[face];
        if (n->block < 0) continue;
        const struct mrt_block *to = &m->map.blocks[n->block];
        const float along = face == CUBE_BACK ? 0.0f : 1.0f;
        const float there = n->face == CUBE_BACK ? 0.0f : 1.0f;
        ++*seams;
        for (int k = 0; k < ALONG; k++) {
            vec3s cell;
            const float around = (float)k / (float)ALONG;
            vec3s edge = mrt_wall_place(from, 0, around, along).position;
            CHECK(mrt_warp_inverse(to->corner, mrt_warp_point(from->corner, edge), &cell));
            const struct tube_place at = tube_locate(mrt_block_bend(to), cell);
            CHECK_NEAR(at.along, there, 1e-4);
            most = fmaxf(most, fabsf(look_up(m, block, around, along) -
                                     look_up(m, n->block, at.around, there)));
        }
    }
    return most;
}

// Around the tube, where the tile begins again.
static float around_error(const struct light_map *m)
{
    float most = 0.0f;
    for (int b = 0; b < m->map.count; b++)
        for (int k = 0; k < ALONG; k++) {
            const float along = (float)k / (float)(ALONG - 1);
            most = fmaxf(most, fabsf(look_up(m, b, 0.0f, along) - look_up(m, b, 1.0f, along)));
        }
    return most;
}

TEST(tubes_have_no_seam_around_them_nor_where_they_meet)
{
    for (int i = 0; i < 6; i++) {
        struct light_map m = make(i == 0 ? mrt_pipes(5) : mrt_tunnel(9, i));
        int seams;
        fill_random(&m, (uint32_t)i);
        // Positions of both sides differ by the rounding of bends.
        CHECK_NEAR(tube_seam_error(&m, &seams), 0, 1e-5);
        CHECK_NEAR(around_error(&m), 0, 1e-5);
        CHECK(seams == 2 * (m.map.count - 1));
        for (int k = 0; k < m.atlas.border_count; k++) m.filled[m.atlas.borders[k].texel] = 0.0f;
        CHECK(tube_seam_error(&m, &seams) > 0.1f && around_error(&m) > 0.1f);
        finish(&m);
    }
}

// The reason for the border: without it, each side repeats its own texels.
TEST(without_the_border_the_sides_of_a_seam_differ)
{
    struct light_map m = make(mrt_random_grid(4, 3, 0.8f, true, 1));
    int seams;
    fill_random(&m, 1);
    for (int i = 0; i < m.atlas.border_count; i++) m.filled[m.atlas.borders[i].texel] = 0.0f;
    CHECK(seam_error(&m, &seams) > 0.1f);
    finish(&m);
}

TEST(a_constant_light_map_is_constant_up_to_its_edges)
{
    struct light_map m = make(mrt_random_grid(5, 4, 0.6f, true, 3));
    for (int i = 0; i < m.atlas.texels; i++) m.values[i] = 1.0f;
    mrt_atlas_fill(&m.atlas, m.values, 1, m.filled);
    for (int t = 0; t < m.atlas.tile_count; t++)
        for (int i = 0; i < ALONG * ALONG; i++) {
            vec2s at = mrt_atlas_place(&m.atlas, t, (float)(i % ALONG) / (float)(ALONG - 1),
                                       (float)(i / ALONG) / (float)(ALONG - 1));
            CHECK_NEAR(mrt_atlas_look_up(&m.atlas, m.filled, 1, 0, at), 1, 1e-6);
        }
    finish(&m);
}

// Lookups in one tile, at least `inside` from all edges, of light on another one.
static float bleeding(const struct light_map *m, int tile, float inside)
{
    float most = 0.0f;
    for (int i = 0; i < ALONG * ALONG; i++) {
        float s = (float)(i % ALONG) / (float)(ALONG - 1);
        float t = (float)(i / ALONG) / (float)(ALONG - 1);
        if (fminf(fminf(s, 1.0f - s), fminf(t, 1.0f - t)) < inside) continue;
        vec2s at = mrt_atlas_place(&m->atlas, tile, s, t);
        most = fmaxf(most, fabsf(mrt_atlas_look_up(&m->atlas, m->filled, 1, 0, at)));
    }
    return most;
}

static bool share_a_vertex(const struct light_map *m, int a, int b)
{
    const struct mrt_tile *tile = &m->atlas.tiles[a];
    for (int c = 0; c < 4; c++) {
        for (int forward = 0; forward < 2; forward++) {
            struct mrt_wall_corner at = { tile->block, tile->face, c };
            for (int i = 0; i < 3 && mrt_wall_continues(&m->map, at, forward, &at); i++)
                if (tile_of(m, at.block, at.face) == b) return true;
        }
    }
    return false;
}

// One tile is lit. Tiles across a crease or a wall stay black up to their edges; those that its
// wall continues to, beyond half a texel.
TEST(nothing_bleeds_across_a_crease_or_a_wall)
{
    struct light_map m = make(mrt_random_grid(3, 3, 0.6f, true, 5));
    int n = RESOLUTION * RESOLUTION, apart = 0;
    for (int lit = 0; lit < m.atlas.tile_count; lit++) {
        for (int i = 0; i < m.atlas.texels; i++) m.values[i] = (float)(i / n == lit);
        mrt_atlas_fill(&m.atlas, m.values, 1, m.filled);
        for (int t = 0; t < m.atlas.tile_count; t++) {
            if (t == lit) continue;
            bool near = share_a_vertex(&m, t, lit);
            apart += !near;
            CHECK(bleeding(&m, t, near ? 0.5f / (float)RESOLUTION : 0.0f) == 0.0f);
        }
    }
    CHECK(apart > 0);
    finish(&m);
}

TEST(lookups_of_light_are_not_negative)
{
    struct light_map m = make(mrt_random_grid(4, 4, 0.7f, true, 6));
    struct rng rng = rng_for(1, 2, 3);
    for (int i = 0; i < m.atlas.texels; i++) // strong contrast
        m.values[i] = rng_float(&rng) < 0.5f ? 0.0f : 1000.0f;
    mrt_atlas_fill(&m.atlas, m.values, 1, m.filled);
    for (int t = 0; t < m.atlas.tile_count; t++)
        for (int i = 0; i < ALONG * ALONG; i++) {
            vec2s at = mrt_atlas_place(&m.atlas, t, (float)(i % ALONG) / (float)(ALONG - 1),
                                       (float)(i / ALONG) / (float)(ALONG - 1));
            CHECK(mrt_atlas_look_up(&m.atlas, m.filled, 1, 0, at) >= -1e-4f);
        }
    finish(&m);
}

TEST(mazes_have_seams_that_agree)
{
    struct light_map m = make(mrt_maze(41, 1));
    int seams;
    fill_random(&m, 9);
    float error = seam_error(&m, &seams);
    print_message("@maze:blocks=41: %d tiles, %d half seams, difference %.1e\n", m.atlas.tile_count,
                  seams, (double)error);
    CHECK(error < 1e-5f);
    finish(&m);
}
