// Points of a grid that are enclosed, and which of them are connected.
#include "map_regions.h"

#include "core/host.h"
#include "core/parallel.h"

#include "techniques/mrt/level/map/map_outside.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_POINTS = 1 << 16, LEAST_ALONG = 2, LEAST_POINTS = 12, LEAST_WALLS = 4 };
static const float ALIGNED = 0.9f; // cosine between a wall's normal and the axis
static const float LARGE = 0.08f;  // least part of a region's cross-section that makes a wall
static const float FILLED = 0.2f;  // least part of its box that is enclosed
static const float FLAT = 0.25f;   // spacings between points: depth of one wall

// ---- the grid

struct grid {
    const struct raycast *raycast;
    vec3s first;
    float spacing, reach;
    int along[3];
    int *region; // of each point: OPEN, ENCLOSED, or a number from 0
};
enum { OPEN = -2, ENCLOSED = -1 };

static size_t grid_count(const struct grid *grid)
{
    return (size_t)grid->along[0] * (size_t)grid->along[1] * (size_t)grid->along[2];
}

static void grid_place(const struct grid *grid, size_t i, int at[3])
{
    const size_t x = (size_t)grid->along[0], y = (size_t)grid->along[1];
    at[0] = (int)(i % x);
    at[1] = (int)(i / x % y);
    at[2] = (int)(i / (x * y));
}

static vec3s grid_point(const struct grid *grid, size_t i)
{
    int at[3];
    grid_place(grid, i, at);
    return glms_vec3_muladds(vec3_of((float)at[0], (float)at[1], (float)at[2]), grid->spacing,
                             grid->first);
}

// The point beside point i; −1: outside of the grid.
static long long grid_beside(const struct grid *grid, size_t i, int face)
{
    const int step = face & 1 ? 1 : -1;
    int at[3];
    grid_place(grid, i, at);
    const int to = at[face / 2] + step;
    if (to < 0 || to >= grid->along[face / 2]) return -1;
    const long long stride[3] = { 1, grid->along[0], (long long)grid->along[0] * grid->along[1] };
    return (long long)i + step * stride[face / 2];
}

static void place_grid(struct box3 bounds, struct grid *grid)
{
    const vec3s size = box3_size(bounds);
    const float longest = glms_vec3_max(size);
    const double least = 1e-3 * (double)longest; // of flat scenes
    const double volume =
        fmax((double)size.x, least) * fmax((double)size.y, least) * fmax((double)size.z, least);
    grid->reach = mrt_roof_reach(bounds);
    grid->spacing = (float)cbrt(volume / MOST_POINTS);
    for (int a = 0; a < 3; a++) {
        grid->along[a] = (int)fmaxf(size.raw[a] / grid->spacing, 1.0f);
        grid->first.raw[a] =
            bounds.min.raw[a] + 0.5f * (size.raw[a] - grid->spacing * (float)(grid->along[a] - 1));
    }
}

static void test_point(void *user, size_t i)
{
    const struct grid *grid = user;
    const vec3s point = grid_point(grid, i);
    grid->region[i] = mrt_is_enclosed(grid->raycast, point, grid->reach) ? ENCLOSED : OPEN;
}

// ---- regions

static vec3s way_of(int face)
{
    vec3s way = vec3_of(0, 0, 0);
    way.raw[face / 2] = face & 1 ? 1.0f : -1.0f;
    return way;
}

// The point beside an enclosed one, if it is enclosed too and nothing is between them; else −1.
static long long connected(const struct grid *grid, size_t i, int face)
{
    const long long to = grid_beside(grid, i, face);
    if (to < 0 || grid->region[to] == OPEN) return -1;
    return raycast_blocked(grid->raycast, grid_point(grid, i), way_of(face), grid->spacing) ? -1
                                                                                            : to;
}

// Numbers all points that are connected with the first one, and appends them.
static size_t flood(struct grid *grid, size_t from, int region, size_t *order)
{
    size_t count = 0;
    grid->region[from] = region;
    order[count++] = from;
    for (size_t next = 0; next < count; next++)
        for (int face = 0; face < CUBE_FACES; face++) {
            const long long to = connected(grid, order[next], face);
            if (to < 0 || grid->region[to] != ENCLOSED) continue;
            grid->region[to] = region;
            order[count++] = (size_t)to;
        }
    return count;
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// The outermost of `hits` distances along a face's direction where many are within the depth of a
// wall; NAN: there is no such wall.
static float outermost(float *hits, size_t count, size_t least, float depth)
{
    qsort(hits, count, sizeof *hits, ascending);
    for (size_t end = count; end >= least; end--) {
        if (hits[end - 1] - hits[end - least] > depth) continue;
        float sum = 0.0f;
        for (size_t k = end - least; k < end; k++) sum += hits[k];
        return sum / (float)least;
    }
    return NAN;
}

// The end of a region towards a face, at its wall. Returns whether there is one; a glazed side has
// none. hits: scratch memory for `count` numbers.
static bool find_end(const struct grid *grid, const size_t *order, size_t count, int face,
                     float *hits, float *end)
{
    const int axis = face / 2;
    const float sign = face & 1 ? 1.0f : -1.0f;
    float farthest = -INFINITY;
    size_t ends = 0, found = 0;
    for (size_t k = 0; k < count; k++) {
        const vec3s from = grid_point(grid, order[k]);
        struct raycast_hit hit;
        farthest = fmaxf(farthest, sign * from.raw[axis]);
        if (connected(grid, order[k], face) >= 0) continue;
        ends++;
        if (!raycast_closest(grid->raycast, from, way_of(face), grid->reach, &hit)) continue;
        if (hit.front && fabsf(hit.normal.raw[axis]) >= ALIGNED)
            hits[found++] = sign * from.raw[axis] + hit.distance;
    }
    const size_t least = (size_t)fmaxf(LARGE * (float)ends, 1.0f);
    const float wall = outermost(hits, found, least, FLAT * grid->spacing);
    *end = sign * (isnan(wall) ? farthest + 0.5f * grid->spacing : wall);
    return !isnan(wall);
}

static bool is_large(const struct grid *grid, const size_t *order, size_t count)
{
    int low[3], high[3];
    grid_place(grid, order[0], low);
    grid_place(grid, order[0], high);
    for (size_t k = 1; k < count; k++) {
        int at[3];
        grid_place(grid, order[k], at);
        for (int a = 0; a < 3; a++) {
            if (at[a] < low[a]) low[a] = at[a];
            if (at[a] > high[a]) high[a] = at[a];
        }
    }
    for (int a = 0; a < 3; a++)
        if (high[a] - low[a] + 1 < LEAST_ALONG) return false;
    return count >= LEAST_POINTS;
}

// Whether the points fill a room: between floor, ceiling and two walls at least.
static bool find_ends(const struct grid *grid, const size_t *order, size_t count, float *hits,
                      struct box3 *bounds)
{
    bool wall[CUBE_FACES];
    int walls = 0;
    for (int face = 0; face < CUBE_FACES; face++) {
        vec3s *corner = face & 1 ? &bounds->max : &bounds->min;
        wall[face] = find_end(grid, order, count, face, hits, &corner->raw[face / 2]);
        walls += wall[face];
    }
    const vec3s size = glms_vec3_divs(box3_size(*bounds), grid->spacing);
    return wall[CUBE_BOTTOM] && wall[CUBE_TOP] && walls >= LEAST_WALLS &&
           (float)count >= FILLED * size.x * size.y * size.z;
}

// Points of other regions are overwritten.
static bool find_regions(struct grid *grid, size_t *order, float *hits, struct mrt_regions *out)
{
    size_t count = 0;
    for (size_t i = 0; i < grid_count(grid); i++) {
        if (grid->region[i] != ENCLOSED) continue;
        struct mrt_region region = { .first = count };
        region.count = flood(grid, i, out->count, order + count);
        if (!is_large(grid, order + count, region.count) ||
            !find_ends(grid, order + count, region.count, hits, &region.bounds))
            continue;
        struct mrt_region *regions =
            host_realloc(out->host, out->regions, (size_t)out->count + 1, sizeof *regions);
        if (!regions) return false;
        out->regions = regions;
        regions[out->count++] = region;
        count += region.count;
    }
    out->points = host_alloc(out->host, count, sizeof *out->points);
    for (size_t k = 0; out->points && k < count; k++) out->points[k] = grid_point(grid, order[k]);
    return out->points;
}

bool mrt_regions_find(struct host *host, const struct raycast *raycast, struct box3 bounds,
                      struct mrt_regions *out)
{
    struct grid grid = { .raycast = raycast };
    place_grid(bounds, &grid);
    *out = (struct mrt_regions){ .host = host };
    grid.region = host_alloc(host, grid_count(&grid), sizeof *grid.region);
    size_t *order = host_alloc(host, grid_count(&grid), sizeof *order);
    float *hits = host_alloc(host, grid_count(&grid), sizeof *hits);
    bool ok = grid.region && order && hits;
    if (ok) {
        parallel_for(grid_count(&grid), 64, test_point, &grid);
        ok = find_regions(&grid, order, hits, out);
    }
    host_free(host, hits);
    host_free(host, order);
    host_free(host, grid.region);
    if (!ok) mrt_regions_finish(out);
    return ok;
}

void mrt_regions_finish(struct mrt_regions *regions)
{
    if (!regions->host) return;
    host_free(regions->host, regions->points);
    host_free(regions->host, regions->regions);
    *regions = (struct mrt_regions){ 0 };
}
