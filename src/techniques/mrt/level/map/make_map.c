// map=single and map=auto.
#include "make_map.h"

#include "map_boxes.h"
#include "map_outside.h"
#include "map_regions.h"

#include "scene/view/defaults.h"

#include <math.h>

static const float FLAT = 0.05f;   // least edge of a single block, of the longest
static const float BESIDE = 0.25f; // of a block's edge

// A plane is in the middle of a flat block.
static struct box3 box_of(struct box3 bounds)
{
    const vec3s size = box3_size(bounds);
    const float least = FLAT * glms_vec3_max(size);
    for (int a = 0; a < 3; a++) {
        const float more = 0.5f * fmaxf(least - size.raw[a], 0.0f);
        bounds.min.raw[a] -= more;
        bounds.max.raw[a] += more;
    }
    return bounds;
}

bool mrt_map_single(struct host *host, const struct scene_pose *pose, struct mrt_block_map *map)
{
    if (!mrt_block_map_init(host, pose->scene->name, 1, map)) return false;
    map->is_single = true;
    mrt_block_init(&map->blocks[0], "scene", MRT_BLOCK_CUBE);
    mrt_block_set_box(&map->blocks[0], box_of(pose->bounds));
    if (mrt_block_map_check(pose->scene->name, map)) return true;
    mrt_block_map_finish(map);
    return false;
}

// The seeds of a search; `default_camera` is one if no other is inside a room.
struct search {
    struct host *host;
    const struct scene_pose *pose;
    const vec3s *seeds;
    size_t seed_count;
    bool default_camera;
};

static bool any_free(const struct mrt_cells *cells)
{
    for (int i = 0; i < mrt_cells_count(cells); i++)
        if (cells->cell[i].free) return true;
    return false;
}

static bool fill(const struct search *search, struct mrt_cells *cells)
{
    if (!mrt_cells_fill(search->host, cells, search->seeds, search->seed_count)) return false;
    if (!search->default_camera || any_free(cells)) return true;
    const vec3s eye = default_camera(search->pose).eye;
    return mrt_cells_fill(search->host, cells, &eye, 1);
}

// Appends the blocks within the cells' bounds.
static bool add_blocks_in(const struct search *search, struct mrt_cells *cells,
                          struct mrt_block_map *map)
{
    const char *what = search->pose->scene->name;
    struct mrt_block_map more = { 0 };
    mrt_cells_find_planes(cells);
    bool ok = fill(search, cells);
    while (ok && mrt_cells_drop_objects(cells)) ok = fill(search, cells);
    if (ok && mrt_cells_join_walls(cells)) ok = fill(search, cells);
    if (ok) {
        mrt_cells_snap(cells);
        mrt_cells_drop_planes(cells, INFINITY);
        mrt_cells_split(cells);
        ok = fill(search, cells);
    }
    ok = ok && mrt_map_of_cells(search->host, what, cells, map->count, &more);
    if (ok && map->count + more.count > MRT_MAX_BLOCKS)
        host_log(search->host, LOG_WARNING, "%s: a room is left out, of blocks beyond %d", what,
                 MRT_MAX_BLOCKS);
    else
        ok = ok && mrt_block_map_append(what, map, &more);
    host_free(search->host, cells->cell);
    mrt_block_map_finish(&more);
    return ok;
}

// Whether a block has the point, or is nearer than BESIDE of its edge. Blocks are boxes.
static bool is_near_blocks(const struct mrt_block_map *map, vec3s point)
{
    for (int b = 0; b < map->count; b++) {
        const vec3s low = map->blocks[b].corner[0], high = map->blocks[b].corner[MRT_CORNERS - 1];
        const vec3s middle = glms_vec3_lerp(low, high, 0.5f);
        const vec3s away = glms_vec3_abs(glms_vec3_sub(point, middle));
        const vec3s most = glms_vec3_scale(glms_vec3_sub(high, low), 0.5f + BESIDE);
        if (away.x <= most.x && away.y <= most.y && away.z <= most.z) return true;
    }
    return false;
}

// Whether earlier blocks have most of a region.
static bool is_covered(const struct mrt_regions *regions, const struct mrt_region *region,
                       const struct mrt_block_map *map)
{
    size_t near = 0;
    for (size_t k = 0; k < region->count; k++)
        near += is_near_blocks(map, regions->points[region->first + k]);
    return 2 * near > region->count;
}

// Rooms that planes of the whole scene have missed.
static bool add_rooms(struct host *host, const struct scene_pose *pose,
                      const struct mrt_cells *scene, struct mrt_block_map *map)
{
    const struct mrt_regions *regions = scene->regions;
    bool ok = true;
    for (int i = 0; ok && i < regions->count; i++) {
        const struct mrt_region *region = &regions->regions[i];
        const struct search search = { host, pose, regions->points + region->first, region->count,
                                       false };
        struct mrt_cells cells = { .raycast = scene->raycast,
                                   .bounds = region->bounds,
                                   .reach_m = scene->reach_m };
        if (!is_covered(regions, region, map)) ok = add_blocks_in(&search, &cells, map);
    }
    return ok;
}

bool mrt_map_auto(struct host *host, const struct scene_pose *pose, const vec3s *seeds,
                  size_t seed_count, struct mrt_block_map *map)
{
    struct raycast raycast = { 0 };
    struct mrt_regions regions = { 0 };
    struct mrt_cells cells = { .raycast = &raycast,
                               .bounds = pose->bounds,
                               .reach_m = mrt_roof_reach(pose->bounds),
                               .regions = &regions };
    const struct search search = { host, pose, seeds, seed_count, true };
    const bool ok = mrt_block_map_init(host, pose->scene->name, 0, map) &&
                    raycast_init(&raycast, host, pose) &&
                    mrt_regions_find(host, &raycast, pose->bounds, &regions) &&
                    add_blocks_in(&search, &cells, map) && add_rooms(host, pose, &cells, map);
    const bool is_open = ok && map->count == 0 && mrt_box_is_open(&raycast, pose->bounds);
    mrt_regions_finish(&regions);
    raycast_finish(&raycast);
    if (!ok || map->count == 0) mrt_block_map_finish(map);
    if (!ok || (!map->blocks && !mrt_map_single(host, pose, map))) return false;
    map->is_open = is_open;
    return true;
}
