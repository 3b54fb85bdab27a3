// Walls between two blocks that only clutter makes, such as an arcade with drapes. A map found in
// the free space has them; they are opened, since the clutter itself occludes. Holes of walls are
// those without the clutter.
#include "techniques/mrt/objects/clutter.h"

#include "techniques/mrt/level/holes.h"
#include "techniques/mrt/level/wall.h"

#include <string.h>

static bool is_blocked(const void *walls, vec3s from, vec3s way)
{
    struct trace_hit hit;
    return trace_closest(walls, from, way, 1.0f, &hit);
}

static bool can_open(const struct mrt_block *block, int face, bool vertical)
{
    return !mrt_block_is_tube(block) && !mrt_block_is_open(block, face) &&
           mrt_block_walls(block) > 1 && (vertical || face / 2 != 1);
}

static bool has_holes(const struct mrt_block *block, int face, const struct mrt_holes *holes)
{
    return mrt_block_has_holes(block, face) &&
           memcmp(&block->holes[face], holes, sizeof *holes) == 0;
}

static bool open_face(struct mrt_block_map *map, const struct trace_scene *walls, int block,
                      int face, bool vertical, bool *any)
{
    for (int other = block + 1; other < map->count; other++) {
        const struct mrt_block *a = &map->blocks[block], *b = &map->blocks[other];
        if (!can_open(a, face, vertical)) return true;
        const int meeting = mrt_meeting_face(a, face, b);
        if (meeting < 0 || !can_open(b, meeting, vertical)) continue;
        struct mrt_holes holes;
        const float share = mrt_find_holes(a, face, is_blocked, walls, &holes);
        if (share < MRT_LEAST_HOLE) continue;
        if (share < MRT_LEAST_OPENING && has_holes(a, face, &holes)) return true;
        mrt_disconnect(map, block, face);
        if (share >= MRT_LEAST_OPENING
                ? !mrt_connect("auto", map, block, face, other, meeting)
                : !mrt_connect_by_holes("auto", map, block, face, other, meeting, &holes))
            return false;
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
