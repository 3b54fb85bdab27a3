#include "techniques/common/probes/rays.h"

#include "core/half.h"
#include "frame/octahedral.h"

#include <math.h>

enum { SIDE = PROBE_DEPTH_SIDE, TILE = PROBE_DEPTH_TILE, TRIES = 16, WAYS = SIDE * SIDE };

// A probe is inside geometry if backs of single-sided surfaces cover more than this part of its
// sphere of directions.
static const float MOST_BACKS = 0.25f;
// Distance of a moved probe from the surface, over the spacing.
static const float CLEARANCE = 0.1f;

// A ray by its place in a map of `side` squares. The solid angle of a square there is its area
// times s³, s the L1 norm of the direction.
static struct probe_ray ray_at(vec3s from, float x, float y, int side)
{
    const float across = 2.0f / (float)side;
    const vec3s d = octahedral_decode((vec2s){ { across * x - 1.0f, across * y - 1.0f } });
    const float s = glms_vec3_norm_one(d);
    return (struct probe_ray){ from, d, s * s * s * across * across };
}

// ---- where it is

struct way_out {
    float distance; // INFINITY: none
    vec3s direction;
};

// The share of the sphere with backs, and where they are.
static float look_around(const struct probe_tracer *tracer, vec3s from, struct way_out *out)
{
    float backs = 0.0f, all = 0.0f;
    for (int i = 0; i < WAYS; i++) {
        const struct probe_ray ray =
            ray_at(from, (float)(i % SIDE) + 0.5f, (float)(i / SIDE) + 0.5f, SIDE);
        bool inside = false;
        const float distance = tracer->trace(tracer->user, &ray, &inside);
        if (out) out[i] = (struct way_out){ inside ? distance : INFINITY, ray.direction };
        all += ray.solid_angle;
        if (inside) backs += ray.solid_angle;
    }
    return backs / all;
}

// The nearest one is taken from the list.
static struct way_out pop_nearest(struct way_out *ways)
{
    int nearest = 0;
    for (int i = 1; i < WAYS; i++)
        if (ways[i].distance < ways[nearest].distance) nearest = i;
    const struct way_out way = ways[nearest];
    ways[nearest].distance = INFINITY;
    return way;
}

bool probe_find_place(const struct probe_tracer *tracer, vec3s center, float spacing_m,
                      vec3s *position)
{
    struct way_out ways[WAYS];
    *position = center;
    if (look_around(tracer, center, ways) <= MOST_BACKS) return true;
    for (int i = 0; i < TRIES; i++) {
        const struct way_out way = pop_nearest(ways);
        if (!isfinite(way.distance)) return false;
        const vec3s offset = glms_vec3_scale(way.direction, way.distance + CLEARANCE * spacing_m);
        if (glms_vec3_max(glms_vec3_abs(offset)) > 0.5f * spacing_m) continue;
        *position = glms_vec3_add(center, offset);
        if (look_around(tracer, *position, NULL) <= MOST_BACKS) return true;
    }
    *position = center;
    return false;
}

// ---- depths

struct probe_sphere probe_sphere_of(int rays)
{
    // Two along an edge of a cell at least: each point of the map has some around it.
    const int across = (int)lroundf(sqrtf((float)rays) / SIDE);
    const struct probe_sphere s = { .side = SIDE * (across > 2 ? across : 2) };
    float sum = 0.0f;
    for (int y = 0; y < s.side; y++)
        for (int x = 0; x < s.side; x++)
            sum += ray_at(vec3_of(0, 0, 0), (float)x + 0.5f, (float)y + 0.5f, s.side).solid_angle;
    return (struct probe_sphere){ s.side, 4.0f * GLM_PIf / sum };
}

float probe_solid_angle(const struct probe_sphere *sphere, vec3s direction)
{
    const float across = 2.0f / (float)sphere->side, norm = glms_vec3_norm_one(direction);
    return sphere->scale * norm * norm * norm * across * across;
}

// Nearness of a hit: spacings over the L1 norm of the way to it.
static float nearness(const struct probe_tracer *tracer, const struct probe_ray *ray, float spacing)
{
    bool inside;
    const float way =
        tracer->trace(tracer->user, ray, &inside) * glms_vec3_norm_one(ray->direction);
    return fminf(fmaxf(spacing / way, PROBE_FAR), PROBE_NEAR);
}

// Squares of the differences between rays and the interpolated map, by point, and their weights.
struct differences {
    float square[PROBE_DEPTHS], weight[PROBE_DEPTHS];
};

static void join(struct differences *d, int a, int b)
{
    d->square[a] = d->square[b] = d->square[a] + d->square[b];
    d->weight[a] = d->weight[b] = d->weight[a] + d->weight[b];
}

// Beyond an edge the map continues at the same edge, mirrored: two points there are one direction.
static void join_edges(struct differences *d)
{
    for (int i = 0; i < SIDE / 2; i++)
        for (int far = 0; far <= SIDE; far += SIDE)
            join(d, i * TILE + far, (SIDE - i) * TILE + far);
    for (int i = 0; i < SIDE / 2; i++)
        for (int far = 0; far <= SIDE; far += SIDE) join(d, far * TILE + i, far * TILE + SIDE - i);
}

static void add_difference(struct differences *d, float x, float y, float near, const float *mean)
{
    const struct probe_depth_place place = probe_depth_place_at(x, y);
    float difference = near;
    for (int k = 0; k < 3; k++) difference -= place.weight[k] * mean[place.point[k]];
    for (int k = 0; k < 3; k++) {
        d->square[place.point[k]] += place.weight[k] * difference * difference;
        d->weight[place.point[k]] += place.weight[k];
    }
}

void probe_trace_depths(const struct probe_sphere *sphere, const struct probe_tracer *tracer,
                        vec3s from, float spacing_m, uint16_t depth[PROBE_DEPTHS][2])
{
    const float cell = (float)SIDE / (float)sphere->side;
    struct differences differences = { 0 };
    float mean[PROBE_DEPTHS];
    for (int i = 0; i < PROBE_DEPTHS; i++) {
        struct probe_ray ray = ray_at(from, (float)(i % TILE), (float)(i / TILE), SIDE);
        ray.solid_angle = 0.0f;
        mean[i] = nearness(tracer, &ray, spacing_m);
    }
    for (int i = 0; i < sphere->side * sphere->side; i++) {
        const float x = (float)(i % sphere->side) + 0.5f, y = (float)(i / sphere->side) + 0.5f;
        struct probe_ray ray = ray_at(from, x, y, sphere->side);
        ray.solid_angle *= sphere->scale;
        add_difference(&differences, cell * x, cell * y, nearness(tracer, &ray, spacing_m), mean);
    }
    join_edges(&differences);
    for (int i = 0; i < PROBE_DEPTHS; i++) {
        depth[i][0] = half_from_float(mean[i]);
        depth[i][1] = half_from_float(sqrtf(differences.square[i] / differences.weight[i]));
    }
}
