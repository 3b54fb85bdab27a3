// Rays tell whether a place is a room.
#include "map_outside.h"

#include "core/rng.h"
#include "core/sampling.h"

#include "techniques/mrt/level/map/map_regions.h"

#include <math.h>

enum { ALONG = 4, SAMPLES = ALONG * ALONG * ALONG }; // in a cell
enum { WAYS = 32, MIDDLE_WAYS = 128 };               // around a point
static const float ESCAPED = 0.15f; // most part of all directions without a surface: enclosed
static const float OUTSIDE = 0.4f;  // least part of them: outdoors
static const float ROOM = 0.33f;    // least enclosed part of a cell that is a room
static const float OPEN = 0.8f;     // least part about a house that is under the sky
static const float FITS = 0.7f;     // least part of a cell that its room has
static const float PART = 0.1f;     // least part of a room that a cell has
static const float REACH = 0.5f;    // of the scene's longest edge
static const float AIR = 0.05f;     // most part of a solid cell

float mrt_roof_reach(struct box3 scene)
{
    return REACH * glms_vec3_max(box3_size(scene));
}

bool mrt_is_enclosed(const struct raycast *raycast, vec3s point, float reach)
{
    struct raycast_hit hit;
    int escaped = 0, backs = 0;
    if (!raycast_closest(raycast, point, vec3_of(0, 1, 0), reach, &hit) || !hit.front) return false;
    for (uint32_t i = 0; i < WAYS; i++) {
        if (!raycast_closest(raycast, point, sample_sphere(sobol_2d(i, 0)), reach, &hit))
            escaped++;
        else
            backs += !hit.front;
        if ((float)escaped > ESCAPED * (float)WAYS || 2 * backs > WAYS) return false;
    }
    return true;
}

static vec3s place_in(const struct mrt_cells *cells, const int at[3], vec3s part)
{
    vec3s point;
    for (int a = 0; a < 3; a++) {
        const float *plane = cells->plane[a] + at[a];
        point.raw[a] = plane[0] + part.raw[a] * (plane[1] - plane[0]);
    }
    return point;
}

// Coordinates of place i in a cell, 0 … 1.
static vec3s part_of(int i)
{
    const vec3s part =
        vec3_of((float)(i % ALONG), (float)(i / ALONG % ALONG), (float)(i / (ALONG * ALONG)));
    return glms_vec3_divs(glms_vec3_adds(part, 0.5f), (float)ALONG);
}

// Place i between the planes of a cell.
static vec3s sample_of(const struct mrt_cells *cells, const int at[3], int i)
{
    return place_in(cells, at, part_of(i));
}

static bool is_mostly_enclosed(const struct mrt_cells *cells, const int at[3])
{
    int enclosed = 0;
    for (int i = 0; i < SAMPLES; i++)
        enclosed += mrt_is_enclosed(cells->raycast, sample_of(cells, at, i), cells->reach_m);
    return (float)enclosed >= ROOM * (float)SAMPLES;
}

// The middle of a room sees surfaces in most directions.
static bool sees_the_sky(const struct mrt_cells *cells, const int at[3])
{
    const float far = 2.0f * glms_vec3_norm(box3_size(cells->bounds));
    const vec3s middle = place_in(cells, at, vec3_of(0.5f, 0.5f, 0.5f));
    int escaped = 0;
    for (uint32_t i = 0; i < MIDDLE_WAYS; i++)
        escaped += !raycast_blocked(cells->raycast, middle, sample_sphere(sobol_2d(i, 0)), far);
    return (float)escaped > OUTSIDE * (float)MIDDLE_WAYS;
}

// Part of all directions from a point in which no surface is, nor the back of one.
static float open_part(const struct raycast *raycast, vec3s point, float far)
{
    struct raycast_hit hit;
    int open = 0, backs = 0;
    for (uint32_t i = 0; i < WAYS; i++) {
        const bool found =
            raycast_closest(raycast, point, sample_sphere(sobol_2d(i, 0)), far, &hit);
        open += !found;
        backs += found && !hit.front;
    }
    return 2 * backs > WAYS ? 1.0f : (float)open / (float)WAYS;
}

bool mrt_box_is_open(const struct raycast *raycast, struct box3 box)
{
    const float far = 2.0f * glms_vec3_norm(box3_size(box));
    float open = 0.0f;
    for (int i = 0; i < SAMPLES; i++)
        open += open_part(raycast, glms_vec3_muladd(part_of(i), box3_size(box), box.min), far);
    return open > OUTSIDE * (float)SAMPLES;
}

static struct box3 bounds_of(const struct mrt_cells *cells, const int at[3])
{
    return (struct box3){ place_in(cells, at, vec3_of(0, 0, 0)),
                          place_in(cells, at, vec3_of(1, 1, 1)) };
}

static bool contains(struct box3 box, vec3s p)
{
    return box3_intersects(box, (struct box3){ p, p });
}

static float common_share(struct box3 cell, struct box3 room)
{
    float share = 1.0f;
    for (int a = 0; a < 3; a++) {
        const float least = fmaxf(cell.min.raw[a], room.min.raw[a]);
        const float most = fminf(cell.max.raw[a], room.max.raw[a]);
        share *= fmaxf(most - least, 0.0f) / (cell.max.raw[a] - cell.min.raw[a]);
    }
    return share;
}

// Whether nearly all of a cell beside a room is outdoors.
static bool is_about_a_house(const struct mrt_cells *cells, const int at[3], struct box3 room)
{
    int beside = 0, open = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const vec3s point = sample_of(cells, at, i);
        struct raycast_hit hit;
        if (contains(room, point)) continue;
        const bool roofed =
            raycast_closest(cells->raycast, point, vec3_of(0, 1, 0), cells->reach_m, &hit);
        beside += !roofed || hit.front; // not in a wall
        open += !roofed;
    }
    return open > 0 && (float)open >= OPEN * (float)beside;
}

static bool has_part_of(const struct mrt_regions *regions, const struct mrt_region *room,
                        struct box3 cell)
{
    size_t inside = 0;
    for (size_t k = 0; k < room->count; k++)
        inside += contains(cell, regions->points[room->first + k]);
    return (float)inside > PART * (float)room->count;
}

// Planes of such a cell are not the walls of the room.
static bool has_a_house(const struct mrt_cells *cells, const int at[3])
{
    const struct box3 cell = bounds_of(cells, at);
    for (int i = 0; i < cells->regions->count; i++) {
        const struct mrt_region *room = &cells->regions->regions[i];
        if (common_share(cell, room->bounds) < FITS && has_part_of(cells->regions, room, cell) &&
            is_about_a_house(cells, at, room->bounds))
            return true;
    }
    return false;
}

bool mrt_cell_is_outside(const struct mrt_cells *cells, const int at[3])
{
    if (!cells->regions) return !is_mostly_enclosed(cells, at);
    return sees_the_sky(cells, at) || has_a_house(cells, at);
}

bool mrt_is_in_solid(const struct mrt_cells *cells, vec3s point)
{
    const float far = 2.0f * glms_vec3_norm(box3_size(cells->bounds));
    int backs = 0;
    for (int face = 0; face < CUBE_FACES; face++) {
        struct raycast_hit hit;
        vec3s way = vec3_of(0, 0, 0);
        way.raw[face / 2] = face & 1 ? 1.0f : -1.0f;
        backs += raycast_closest(cells->raycast, point, way, far, &hit) && !hit.front;
    }
    return 2 * backs > CUBE_FACES;
}

bool mrt_cell_is_solid(const struct mrt_cells *cells, const int at[3])
{
    int air = 0;
    for (int i = 0; i < SAMPLES; i++) {
        air += !mrt_is_in_solid(cells, sample_of(cells, at, i));
        if ((float)air > AIR * (float)SAMPLES) return false;
    }
    return true;
}
