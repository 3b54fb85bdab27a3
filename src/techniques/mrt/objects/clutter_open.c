// Walls between two blocks that only clutter makes, such as an arcade with drapes. A map found in
// the free space has them; they are opened, since the clutter itself occludes.
#include "techniques/mrt/objects/clutter.h"

#include "techniques/mrt/level/wall.h"

enum { ALONG = 8 }; // rays along each edge of a face

// Edges to either side of a face where a wall of it may be, as in clutter_find.c.
static const float REACH = 0.15f;
static const float LEAST_WALL = 0.5f; // share of rays that hit a wall

static float share_with_wall(const struct trace_scene *walls, const struct mrt_block *block,
                             int face)
{
    int hits = 0;
    for (int i = 0; i < ALONG * ALONG; i++) {
        const float s = ((float)(i % ALONG) + 0.5f) / ALONG;
        const float t = ((float)(i / ALONG) + 0.5f) / ALONG;
        vec3s inner = mrt_wall_place(block, face, s, t).position, outer = inner;
        inner.raw[face / 2] *= 1.0f - 2.0f * REACH;
        outer.raw[face / 2] *= 1.0f + 2.0f * REACH;
        const vec3s from = mrt_warp_point(block->corner, inner);
        const vec3s way = glms_vec3_sub(mrt_warp_point(block->corner, outer), from);
        struct trace_hit hit;
        hits += trace_closest(walls, from, way, 1.0f, &hit);
    }
    return (float)hits / (ALONG * ALONG);
}

static bool can_open(const struct mrt_block *block, int face, bool vertical)
{
    return !mrt_block_is_tube(block) && !mrt_block_is_open(block, face) &&
           mrt_block_walls(block) > 1 && (vertical || face / 2 != 1);
}

static bool open_face(struct mrt_block_map *map, const struct trace_scene *walls, int block,
                      int face, bool vertical, bool *any)
{
    for (int other = block + 1; other < map->count; other++) {
        const struct mrt_block *a = &map->blocks[block], *b = &map->blocks[other];
        if (!can_open(a, face, vertical)) return true;
        const int meeting = mrt_meeting_face(a, face, b);
        if (meeting < 0 || !can_open(b, meeting, vertical)) continue;
        if (share_with_wall(walls, a, face) >= LEAST_WALL) continue;
        if (!mrt_connect("auto", map, block, face, other, meeting)) return false;
        *any = true;
    }
    return true;
}

bool mrt_open_clutter_walls(struct mrt_block_map *map, const struct mrt_clutter *clutter,
                            bool vertical, bool *any)
{
    struct trace_scene *walls = trace_scene_create(clutter->host, &clutter->walls.pose);
    bool ok = walls;
    *any = false;
    for (int b = 0; ok && b < map->count; b++)
        for (int f = 0; ok && f < CUBE_FACES; f++) ok = open_face(map, walls, b, f, vertical, any);
    trace_scene_destroy(walls);
    return ok;
}
