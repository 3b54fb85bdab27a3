// Probes outside of all blocks.
#include "techniques/mrt/level/area_light.h"

#include <math.h>

enum { MAX_POINTS = 12, RAYS = 128 }; // points along the longest side of the scene

// Least part of all directions with the sky where nothing else than it is above: as map_cells.c.
static const float OUTSIDE = 0.4f;

static const float IN_CELL = 0.5f + 1e-3f; // points on a wall are the room's

// Points at both ends of the longest side.
static struct frame_probes grid_of(struct box3 bounds)
{
    const vec3s size = box3_size(bounds);
    const float spacing = glms_vec3_max(size) / (float)(MAX_POINTS - 1);
    struct frame_probes grid = { .first_m = bounds.min, .spacing_m = spacing };
    int32_t *const counts[3] = { &grid.count_x, &grid.count_y, &grid.count_z };
    for (int a = 0; a < 3; a++) {
        *counts[a] = (int32_t)ceilf(size.raw[a] / spacing - 1e-3f) + 1;
        grid.first_m.raw[a] += 0.5f * (size.raw[a] - spacing * (float)(*counts[a] - 1));
    }
    grid.slab = grid.count_z;
    return grid;
}

static bool is_in_block(const struct mrt_block_map *map, vec3s point)
{
    for (int b = 0; b < map->count; b++) {
        vec3s cell;
        if (mrt_warp_inverse(map->blocks[b].corner, point, &cell) &&
            glms_vec3_max(glms_vec3_abs(cell)) <= IN_CELL)
            return true;
    }
    return false;
}

static void premultiply(struct mrt_outdoor_probe *probe)
{
    for (int k = 0; k < MRT_PROBE_VALUES; k++) {
        probe->light.emitted[k] = glms_vec3_scale(probe->light.emitted[k], probe->open);
        probe->light.sky[k] *= probe->open;
    }
}

// A sky of radiance 1/π gives each normal the irradiance 1, which is √4π Y₀.
static float sky_share(const struct mrt_area_light_probe *probe)
{
    return probe->sky[0] / sqrtf(4.0f * GLM_PIf);
}

// The points of the grid outside of all blocks.
struct points {
    int count;
    int *index;
    vec3s *position;
    struct mrt_area_light_probe *light;
    bool *solid;
};

static bool points_alloc(struct points *points, struct host *host, size_t count)
{
    points->index = host_alloc(host, count, sizeof *points->index);
    points->position = host_alloc(host, count, sizeof *points->position);
    points->light = host_alloc(host, count, sizeof *points->light);
    points->solid = host_alloc(host, count, sizeof *points->solid);
    return points->index && points->position && points->light && points->solid;
}

static void points_finish(struct points *points, struct host *host)
{
    host_free(host, points->index);
    host_free(host, points->position);
    host_free(host, points->light);
    host_free(host, points->solid);
}

static void find_points(struct points *points, const struct mrt_block_map *map,
                        struct frame_probes grid, int count)
{
    for (int i = 0; i < count; i++) {
        const vec3s position = probe_grid_point(grid, (uint32_t)i);
        if (is_in_block(map, position)) continue;
        points->index[points->count] = i;
        points->position[points->count++] = position;
    }
}

// Whether any is outdoors.
static bool place_points(const struct points *points, struct mrt_outdoor_probe *out)
{
    bool any = false;
    for (int i = 0; i < points->count; i++) {
        struct mrt_outdoor_probe *probe = &out[points->index[i]];
        probe->light = points->light[i];
        probe->open = points->solid[i] ? 0.0f : fminf(sky_share(&probe->light) / OUTSIDE, 1.0f);
        premultiply(probe);
        any |= probe->open > 0.0f;
    }
    return any;
}

bool mrt_outdoors_init(struct host *host, const struct mrt_block_map *map, struct box3 bounds,
                       const struct trace_scene *scene, struct mrt_outdoors *out)
{
    struct points points = { 0 };
    *out = (struct mrt_outdoors){ .host = host, .grid = grid_of(bounds) };
    const int count = (int)probe_grid_count(out->grid);
    out->probes = host_alloc(host, (size_t)count, sizeof *out->probes);
    bool ok = out->probes && points_alloc(&points, host, (size_t)count);
    if (ok) {
        find_points(&points, map, out->grid, count);
        ok = mrt_area_light_points(host, scene, RAYS,
                                   &(struct mrt_area_light_points){ (size_t)points.count,
                                                                    points.position, points.light,
                                                                    points.solid });
    }
    if (ok && !place_points(&points, out->probes)) mrt_outdoors_finish(out);
    points_finish(&points, host);
    return ok;
}

void mrt_outdoors_finish(struct mrt_outdoors *outdoors)
{
    if (outdoors->host) host_free(outdoors->host, outdoors->probes);
    *outdoors = (struct mrt_outdoors){ 0 };
}
