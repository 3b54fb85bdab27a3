#include "techniques/mrt/mrt_map_fixture.h"

#include "framework/test.h"

#include "core/rng.h"

#include "scene/scene.h"

#include <stdio.h>

static void turn_axes(struct mrt_block *block, int from_x, int from_y, int flip)
{
    struct mrt_block old = *block;
    int from_z = 3 - from_x - from_y;
    for (int c = 0; c < MRT_CORNERS; c++) {
        int d = c ^ flip;
        block->corner[c] =
            old.corner[(d & 1) << from_x | (d >> 1 & 1) << from_y | (d >> 2 & 1) << from_z];
    }
}

void mrt_turn_block(struct mrt_block *block, int orientation)
{
    struct mrt_block old = *block;
    for (int i = 0; i < 72; i++) {
        int x = i % 3, y = i / 3 % 3;
        if (x == y) continue;
        *block = old;
        turn_axes(block, x, y, i / 9);
        if (!mrt_warp_folds(block->corner) && orientation-- == 0) return;
    }
    CHECK(false);
}

static void connect_if(struct mrt_block_map *map, int a, int b, bool open)
{
    if (!open) return;
    for (int f = 0; f < CUBE_FACES; f++) {
        int other = mrt_meeting_face(&map->blocks[a], f, &map->blocks[b]);
        if (other >= 0) CHECK(mrt_connect("grid", map, a, f, b, other));
    }
}

struct mrt_block_map mrt_random_grid(int columns, int rows, float open, bool turned, uint32_t seed)
{
    struct mrt_block_map map;
    struct rng rng = rng_for(seed, 0, 0);
    CHECK(mrt_block_map_init(test_host(), "grid", (size_t)(columns * rows), &map));
    for (int b = 0; b < map.count; b++) {
        char name[16];
        float x = (float)(b % columns), z = (float)(b / columns);
        snprintf(name, sizeof name, "cube %d", b);
        mrt_block_init(&map.blocks[b], name, MRT_BLOCK_CUBE);
        mrt_block_set_box(&map.blocks[b],
                          (struct box3){ vec3_of(x, 0, z), vec3_of(x + 1, 1, z + 1) });
        int orientation = (int)(rng_u32(&rng) % MRT_ORIENTATIONS);
        if (turned) mrt_turn_block(&map.blocks[b], orientation);
        if (b % columns > 0) connect_if(&map, b, b - 1, rng_float(&rng) < open);
        if (b >= columns) connect_if(&map, b, b - columns, rng_float(&rng) < open);
    }
    CHECK(mrt_block_map_check("grid", &map));
    return map;
}

static struct mrt_block_map map_of(const char *spec)
{
    struct mrt_block_map map;
    struct scene *scene = scene_load(test_host(), spec);
    CHECK(scene && mrt_block_map_of_scene(test_host(), scene, &map));
    scene_destroy(scene);
    return map;
}

struct mrt_block_map mrt_maze(int blocks, int seed)
{
    char spec[64];
    snprintf(spec, sizeof spec, "@maze:blocks=%d,seed=%d", blocks, seed);
    return map_of(spec);
}

struct mrt_block_map mrt_tunnel(int pieces, int seed)
{
    char spec[64];
    snprintf(spec, sizeof spec, "@tunnel:pieces=%d,seed=%d", pieces, seed);
    return map_of(spec);
}

struct mrt_block_map mrt_pipes(int count)
{
    struct mrt_block_map map;
    CHECK(mrt_block_map_init(test_host(), "pipes", (size_t)count, &map));
    for (int b = 0; b < count; b++) {
        struct mrt_block *block = &map.blocks[b];
        char name[16];
        snprintf(name, sizeof name, "pipe %d", b);
        mrt_block_init(block, name, MRT_BLOCK_STRAIGHT);
        mrt_block_set_box(block,
                          (struct box3){ vec3_of(0, 0, (float)b), vec3_of(1, 1, (float)b + 1.0f) });
        const struct mrt_block whole = *block;
        for (int c = 0; b % 2 && c < MRT_CORNERS; c++) block->corner[c] = whole.corner[c ^ 5];
        const int face = b % 2 ? CUBE_FRONT : CUBE_BACK;
        if (b > 0) CHECK(mrt_connect("pipes", &map, b, face, b - 1, face));
    }
    CHECK(mrt_block_map_check("pipes", &map));
    return map;
}
