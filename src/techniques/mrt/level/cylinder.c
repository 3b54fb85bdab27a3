// Cylinders as warped cubes. A bend is a cube whose ends are at right
// angles; the square of its ends has the area of the pipe, so that the same light passes.
#include "block_map.h"

static const float HALF = 0.886227f * MRT_CYLINDER_RADIUS; // √π/2

struct connection {
    int block, end, other; // end: 0 at −z, 1 at the exit
};

static int exit_of(enum mrt_block_kind kind)
{
    return kind == MRT_BLOCK_LEFT ? CUBE_RIGHT : kind == MRT_BLOCK_RIGHT ? CUBE_LEFT : CUBE_FRONT;
}

// The point of the cell at a corner of the cube that stands for the cylinder.
static vec3s cube_corner(enum mrt_block_kind kind, int corner)
{
    float x = corner & 1 ? HALF : -HALF, y = corner & 2 ? HALF : -HALF;
    if (!(corner & 4)) return vec3_of(x, y, -0.5f);
    // The side towards the bend stays inside.
    if (kind == MRT_BLOCK_LEFT) return vec3_of(0.5f, y, -x);
    if (kind == MRT_BLOCK_RIGHT) return vec3_of(-0.5f, y, x);
    return vec3_of(x, y, 0.5f);
}

static void make_cube(struct mrt_block *block)
{
    vec3s corner[MRT_CORNERS];
    for (int c = 0; c < MRT_CORNERS; c++)
        corner[c] = mrt_warp_point(block->corner, cube_corner(block->kind, c));
    for (int c = 0; c < MRT_CORNERS; c++) block->corner[c] = corner[c];
    block->kind = MRT_BLOCK_CUBE;
    block->open = 0;
    for (int f = 0; f < CUBE_FACES; f++) block->neighbor[f].block = -1;
}

// Connections of cylinders, each from one side.
static int list_connections(const struct mrt_block_map *map, struct connection *out)
{
    int count = 0;
    for (int b = 0; b < map->count; b++) {
        const struct mrt_block *block = &map->blocks[b];
        if (block->kind == MRT_BLOCK_CUBE) continue;
        const int ends[2] = { CUBE_BACK, exit_of(block->kind) };
        for (int e = 0; e < 2; e++) {
            int other = block->neighbor[ends[e]].block;
            if (other < 0) continue;
            // The first of two cylinders lists their connection.
            if (other < b && map->blocks[other].kind != MRT_BLOCK_CUBE) continue;
            out[count++] = (struct connection){ b, e, other };
        }
    }
    return count;
}

static void close_towards(struct mrt_block_map *map, struct mrt_block *cube)
{
    for (int f = 0; f < CUBE_FACES; f++) {
        struct mrt_neighbor *n = &cube->neighbor[f];
        if (n->block >= 0 && map->blocks[n->block].kind != MRT_BLOCK_CUBE) n->block = -1;
    }
}

bool mrt_block_map_as_cubes(const char *what, struct mrt_block_map *map)
{
    struct connection *connections =
        host_alloc(map->host, 2 * (size_t)map->count, sizeof *connections);
    if (!connections) return false;
    int count = list_connections(map, connections);
    for (int b = 0; b < map->count; b++)
        if (map->blocks[b].kind == MRT_BLOCK_CUBE) close_towards(map, &map->blocks[b]);
    for (int b = 0; b < map->count; b++)
        if (map->blocks[b].kind != MRT_BLOCK_CUBE) make_cube(&map->blocks[b]);
    bool ok = true;
    for (int i = 0; ok && i < count; i++) {
        const struct connection *c = &connections[i];
        int face = c->end ? CUBE_FRONT : CUBE_BACK;
        int other = mrt_meeting_face(&map->blocks[c->block], face, &map->blocks[c->other]);
        if (other < 0)
            ok = host_fail(map->host, FAIL_UNSUPPORTED,
                           "%s: block %s: its end does not meet block %s, which is not a cylinder",
                           what, map->blocks[c->block].name, map->blocks[c->other].name);
        else
            ok = mrt_connect(what, map, c->block, face, c->other, other);
    }
    host_free(map->host, connections);
    return ok && mrt_block_map_check(what, map);
}
