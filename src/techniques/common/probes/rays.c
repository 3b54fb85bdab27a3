#include "techniques/common/probes/rays.h"

#include "core/half.h"
#include "frame/octahedral.h"

#include <math.h>

enum { SIDE = PROBE_DEPTH_SIDE, TRIES = 16 };

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
    for (int i = 0; i < PROBE_DEPTHS; i++) {
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
    for (int i = 1; i < PROBE_DEPTHS; i++)
        if (ways[i].distance < ways[nearest].distance) nearest = i;
    const struct way_out way = ways[nearest];
    ways[nearest].distance = INFINITY;
    return way;
}

bool probe_find_place(const struct probe_tracer *tracer, vec3s center, float spacing_m,
                      vec3s *position)
{
    struct way_out ways[PROBE_DEPTHS];
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
    // Two along an edge at least: the distances of a square are fitted by a linear function.
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

// Sums over the rays of a square, by their offset from its middle in squares.
struct moments {
    float sum, square, along[2];
};

// Mean, and standard deviation about a linear function.
static void finish_moments(const struct moments *m, int across, uint16_t out[2])
{
    const float count = (float)(across * across), mean = m->sum / count;
    const float spread = (1.0f - 1.0f / count) / 12.0f; // mean square of an offset
    float variance = m->square / count - mean * mean;
    for (int a = 0; a < 2; a++) variance -= m->along[a] * m->along[a] / (count * count * spread);
    out[0] = half_from_float(mean);
    out[1] = half_from_float(sqrtf(fmaxf(variance, 0.0f)));
}

// Nearness of a hit: spacings over the L1 norm of the way to it.
static float nearness(const struct probe_tracer *tracer, const struct probe_ray *ray, float spacing)
{
    bool inside;
    const float way =
        tracer->trace(tracer->user, ray, &inside) * glms_vec3_norm_one(ray->direction);
    return fminf(fmaxf(spacing / way, PROBE_FAR), PROBE_NEAR);
}

void probe_trace_depths(const struct probe_sphere *sphere, const struct probe_tracer *tracer,
                        vec3s from, float spacing_m, uint16_t depth[PROBE_DEPTHS][2])
{
    const int across = sphere->side / SIDE;
    for (int square = 0; square < PROBE_DEPTHS; square++) {
        struct moments moments = { 0 };
        for (int i = 0; i < across * across; i++) {
            const float x = ((float)(i % across) + 0.5f) / (float)across;
            const float y = ((float)(i / across) + 0.5f) / (float)across;
            struct probe_ray ray =
                ray_at(from, ((float)(square % SIDE) + x) * (float)across,
                       ((float)(square / SIDE) + y) * (float)across, sphere->side);
            ray.solid_angle *= sphere->scale;
            const float near = nearness(tracer, &ray, spacing_m);
            moments.sum += near;
            moments.square += near * near;
            moments.along[0] += near * (x - 0.5f);
            moments.along[1] += near * (y - 0.5f);
        }
        finish_moments(&moments, across, depth[square]);
    }
}
