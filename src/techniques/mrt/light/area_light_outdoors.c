// Probes outside of all blocks.
#include "techniques/mrt/light/area_light.h"

#include "core/sh.h"

#include <math.h>

enum { LEAST_POINTS = 12, POINTS = 4096, RAYS = 128 }; // along the longest side; some, of all

// Least part of all directions with the sky where nothing else than it is above: as map_cells.c.
static const float OUTSIDE = 0.4f;

// Cubes between the points have an edge that gives POINTS of them. A side counts as no shorter than
// one of LEAST_POINTS on the longest side.
static float spacing_of(vec3s size)
{
    const float coarsest = glms_vec3_max(size) / (float)(LEAST_POINTS - 1);
    const vec3s sides = glms_vec3_maxv(size, vec3_of(coarsest, coarsest, coarsest));
    return fminf(coarsest, cbrtf(sides.x * sides.y * sides.z / (float)POINTS));
}

// Points at both ends of each side, or beyond.
static struct frame_probes grid_of(struct box3 bounds)
{
    const vec3s size = box3_size(bounds);
    const float spacing = spacing_of(size);
    struct frame_probes grid = { .first_m = bounds.min, .spacing_m = spacing };
    int32_t *const counts[3] = { &grid.count_x, &grid.count_y, &grid.count_z };
    for (int a = 0; a < 3; a++) {
        *counts[a] = (int32_t)ceilf(size.raw[a] / spacing - 1e-3f) + 1;
        grid.first_m.raw[a] += 0.5f * (size.raw[a] - spacing * (float)(*counts[a] - 1));
    }
    grid.slab = grid.count_z;
    return grid;
}

// A sky of radiance 1/π gives each normal the irradiance 1, which is √4π Y₀.
static float sky_share(const struct mrt_area_light_probe *probe)
{
    return probe->sky[0] / sqrtf(4.0f * GLM_PIf);
}

// A place below the ground sees the sky below the horizon only.
static float sky_above(const struct mrt_area_light_probe *probe)
{
    const float on_top = sh_dot(3, probe->sky, vec3_of(0, 1, 0));
    return fmaxf(fminf(sky_share(probe), on_top), 0.0f);
}

// Premultiplied. Returns whether the point is outdoors.
static bool place_point(const struct mrt_lit_point *point, struct mrt_reflectors *reflectors,
                        struct mrt_outdoor_probe *out)
{
    const struct mrt_reflector_row row = point->light.reflected;
    out->light = point->light;
    out->open = point->solid ? 0.0f : fminf(sky_above(&point->light) / OUTSIDE, 1.0f);
    for (int k = 0; k < MRT_PROBE_VALUES; k++) {
        out->light.emitted[k] = glms_vec3_scale(out->light.emitted[k], out->open);
        out->light.sky[k] *= out->open;
    }
    for (uint32_t k = row.first; k < row.first + row.count; k++)
        reflectors->shares[k].weight *= out->open;
    return out->open > 0.0f;
}

bool mrt_outdoors_init(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                       struct box3 bounds, struct mrt_outdoors *out)
{
    struct host *host = reflectors->host;
    *out = (struct mrt_outdoors){ .host = host, .grid = grid_of(bounds) };
    const int count = (int)probe_grid_count(out->grid);
    struct mrt_lit_point *points = host_alloc(host, (size_t)count, sizeof *points);
    int *probe_of = host_alloc(host, (size_t)count, sizeof *probe_of); // of each point
    int outside = 0;
    out->probes = host_alloc(host, (size_t)count, sizeof *out->probes);
    bool ok = out->probes && points && probe_of, any = false;
    for (int i = 0; ok && i < count; i++) {
        const vec3s position = probe_grid_point(out->grid, (uint32_t)i);
        if (mrt_is_in_a_block(&reflectors->grid, position)) continue;
        probe_of[outside] = i;
        points[outside++].position = position;
    }
    ok = ok && mrt_area_light_points(scene, reflectors, RAYS, points, (size_t)outside);
    for (int k = 0; ok && k < outside; k++)
        any |= place_point(&points[k], reflectors, &out->probes[probe_of[k]]);
    if (ok && !any) mrt_outdoors_finish(out);
    host_free(host, points);
    host_free(host, probe_of);
    return ok;
}

void mrt_outdoors_finish(struct mrt_outdoors *outdoors)
{
    if (outdoors->host) host_free(outdoors->host, outdoors->probes);
    *outdoors = (struct mrt_outdoors){ 0 };
}

uint64_t mrt_outdoors_bytes(void)
{
    const uint64_t shares = RAYS * sizeof(struct mrt_reflector_share);
    return POINTS * (sizeof(struct mrt_outdoor_probe) + shares);
}
