#include "techniques/radiosity/probes/bake.h"

#include "core/rng.h"
#include "core/sh.h"
#include "frame/octahedral.h"

#include <math.h>

enum { SIDE = PROBE_DEPTH_SIDE, LOOKS = SIDE * SIDE, TRIES = 16 };

// Of the sphere: a probe that sees more backs of single-sided surfaces is inside of something.
static const float MOST_BACKS = 0.25f;
// Of a spacing: how far a moved probe is in front of the surface.
static const float CLEARANCE = 0.1f;

static float norm_1(vec3s v)
{
    return fabsf(v.x) + fabsf(v.y) + fabsf(v.z);
}

// A direction by its place in a map of `side` squares, and the solid angle of a square there: with
// the L1 norm s of the direction s³ times its area.
static vec3s direction_at(float x, float y, int side, float *solid_angle)
{
    const float across = 2.0f / (float)side;
    const vec3s d = octahedral_decode((vec2s){ { across * x - 1.0f, across * y - 1.0f } });
    const float s = norm_1(d);
    *solid_angle = s * s * s * across * across;
    return d;
}

// ---- where it is

struct way_out {
    float distance; // INFINITY: none
    vec3s direction;
};

// The share of the sphere with backs, and where they are.
static float look_around(const struct radiosity_scene *scene, vec3s from, struct way_out *out)
{
    float backs = 0.0f, all = 0.0f;
    for (int i = 0; i < LOOKS; i++) {
        float solid_angle;
        const vec3s d =
            direction_at((float)(i % SIDE) + 0.5f, (float)(i / SIDE) + 0.5f, SIDE, &solid_angle);
        const struct ray ray = { from, d, 0.0f, INFINITY };
        struct ray_hit hit;
        const bool inside = embree_closest(scene->trace->embree, &ray, NULL, false, &hit) &&
                            radiosity_seen_at(scene, &ray, &hit).inside;
        if (out) out[i] = (struct way_out){ inside ? hit.distance : INFINITY, d };
        all += solid_angle;
        if (inside) backs += solid_angle;
    }
    return backs / all;
}

// The nearest one is taken from the list.
static struct way_out take_nearest(struct way_out *ways)
{
    int nearest = 0;
    for (int i = 1; i < LOOKS; i++)
        if (ways[i].distance < ways[nearest].distance) nearest = i;
    const struct way_out way = ways[nearest];
    ways[nearest].distance = INFINITY;
    return way;
}

// Its middle, or where that is inside of something, the nearest place before a surface of it that
// is not, within the cell. False: there is none.
static bool find_place(const struct radiosity_scene *scene, vec3s center, float spacing,
                       vec3s *position)
{
    struct way_out ways[LOOKS];
    *position = center;
    if (look_around(scene, center, ways) <= MOST_BACKS) return true;
    for (int i = 0; i < TRIES; i++) {
        const struct way_out way = take_nearest(ways);
        if (!isfinite(way.distance)) return false;
        const vec3s offset = glms_vec3_scale(way.direction, way.distance + CLEARANCE * spacing);
        if (glms_vec3_max(glms_vec3_abs(offset)) > 0.5f * spacing) continue;
        *position = glms_vec3_add(center, offset);
        if (look_around(scene, *position, NULL) <= MOST_BACKS) return true;
    }
    *position = center;
    return false;
}

// ---- what it sees

static void add_sh(vec3s direction, float weight, float *sum, int stride)
{
    float basis[RADIOSITY_SH];
    sh_eval(3, direction, basis);
    for (int i = 0; i < RADIOSITY_SH; i++) sum[i * stride] += weight * basis[i];
}

// From radiance to irradiance.
static void finish_sh(float *sh, int stride)
{
    float radiance[RADIOSITY_SH], irradiance[RADIOSITY_SH];
    for (int i = 0; i < RADIOSITY_SH; i++) radiance[i] = sh[i * stride];
    sh_irradiance(3, radiance, irradiance);
    for (int i = 0; i < RADIOSITY_SH; i++) sh[i * stride] = irradiance[i];
}

static void add_emission(struct radiosity_probe *out, vec3s direction, vec3s radiance,
                         float density)
{
    for (int c = 0; c < 3; c++)
        add_sh(direction, radiance.raw[c] / density, &out->emitted[0][c], 3);
}

static void add_cluster(struct radiosity_gather *gather, uint32_t cluster, vec3s direction,
                        float share)
{
    struct radiosity_factor *factor = &gather->factor[cluster];
    if (factor->weight == 0.0f) gather->met[gather->met_count++] = cluster;
    factor->weight += share;
    for (int a = 0; a < 3; a++) factor->along[a] += share * direction.raw[a];
}

struct sphere {
    int side;               // squares along an edge
    uint32_t light_samples; // 0: no emissive surfaces
    float scale;            // solid angles of the rays sum to 4π with it
    uint32_t seed;
};

// Spacings over the L1 norm of the way to what it meets.
static float trace_ray(const struct radiosity_scene *scene, const struct sphere *sphere,
                       float spacing, vec3s direction, float solid_angle,
                       struct radiosity_gather *gather, struct radiosity_probe *out)
{
    const struct ray ray = { out->position, direction, 0.0f, INFINITY };
    struct ray_hit hit;
    if (!embree_closest(scene->trace->embree, &ray, NULL, false, &hit)) {
        add_sh(direction, solid_angle, out->sky, 1);
        return PROBE_FAR;
    }
    const struct radiosity_seen seen = radiosity_seen_at(scene, &ray, &hit);
    if (glms_vec3_max(seen.emission) > 0.0f)
        add_emission(out, direction, seen.emission,
                     1.0f / solid_angle + (float)sphere->light_samples * seen.pdf);
    if (seen.cluster != CHART_NONE)
        add_cluster(gather, seen.cluster, direction, solid_angle / (4.0f * GLM_PIf));
    const float way = hit.distance * norm_1(direction);
    return fminf(fmaxf(spacing / way, PROBE_FAR), PROBE_NEAR);
}

static struct sphere sphere_of(const struct radiosity_scene *scene, uint32_t seed)
{
    const int rays = 2 * scene->options.rays;
    // Two along an edge at least: the distances of a square are fitted by a linear function.
    const int across = (int)lroundf(sqrtf((float)rays) / SIDE);
    struct sphere s = { .side = SIDE * (across > 2 ? across : 2), .scale = 1.0f, .seed = seed };
    if (scene->trace->lights.has_emitters)
        s.light_samples = (uint32_t)(rays / RADIOSITY_RAYS_PER_LIGHT_SAMPLE);
    float sum = 0.0f, solid_angle;
    for (int y = 0; y < s.side; y++)
        for (int x = 0; x < s.side; x++) {
            (void)direction_at((float)x + 0.5f, (float)y + 0.5f, s.side, &solid_angle);
            sum += solid_angle;
        }
    s.scale = 4.0f * GLM_PIf / sum;
    return s;
}

// Sums over the rays of a square, by their offset from its middle in squares.
struct moments {
    float sum, square, along[2];
};

// Mean, and what is left of the standard deviation about a linear function.
static void finish_moments(const struct moments *m, int across, float *out)
{
    const float count = (float)(across * across), mean = m->sum / count;
    const float spread = (1.0f - 1.0f / count) / 12.0f; // mean square of an offset
    float variance = m->square / count - mean * mean;
    for (int a = 0; a < 2; a++) variance -= m->along[a] * m->along[a] / (count * count * spread);
    out[0] = mean;
    out[1] = sqrtf(fmaxf(variance, 0.0f));
}

static void trace_square(const struct radiosity_scene *scene, const struct sphere *sphere,
                         float spacing, int square, struct radiosity_gather *gather,
                         struct radiosity_probe *out)
{
    struct moments moments = { 0 };
    const int across = sphere->side / SIDE;
    for (int i = 0; i < across * across; i++) {
        const float x = ((float)(i % across) + 0.5f) / (float)across;
        const float y = ((float)(i / across) + 0.5f) / (float)across;
        float solid_angle;
        const vec3s d =
            direction_at(((float)(square % SIDE) + x) * (float)across,
                         ((float)(square / SIDE) + y) * (float)across, sphere->side, &solid_angle);
        const float near =
            trace_ray(scene, sphere, spacing, d, sphere->scale * solid_angle, gather, out);
        moments.sum += near;
        moments.square += near * near;
        moments.along[0] += near * (x - 0.5f);
        moments.along[1] += near * (y - 0.5f);
    }
    finish_moments(&moments, across, out->depth[square]);
}

static void sample_emitters(const struct radiosity_scene *scene, const struct sphere *sphere,
                            struct radiosity_probe *out)
{
    const float across = 2.0f / (float)sphere->side;
    for (uint32_t k = 0; k < sphere->light_samples; k++) {
        struct emitter_sample s;
        if (!radiosity_sample_emitter(scene, out->position, NULL, k, sphere->light_samples,
                                      sphere->seed, &s))
            continue;
        const vec3s d = s.to_light;
        const float norm = norm_1(d);
        const float solid_angle = sphere->scale * norm * norm * norm * across * across;
        add_emission(out, d, s.radiance, 1.0f / solid_angle + (float)sphere->light_samples * s.pdf);
    }
}

void radiosity_probe_gather(const struct radiosity_scene *scene, struct frame_probes grid,
                            uint32_t probe, uint64_t seed, struct radiosity_gather *gather,
                            struct radiosity_probe *out)
{
    *out = (struct radiosity_probe){ .valid = 1.0f };
    radiosity_gather_clear(gather);
    if (!find_place(scene, radiosity_probe_center(grid, probe), grid.spacing_m, &out->position)) {
        out->valid = 0.0f;
        return;
    }
    const struct sphere sphere = sphere_of(scene, (uint32_t)rng_mix(seed ^ (uint64_t)probe << 32));
    for (int i = 0; i < LOOKS; i++) trace_square(scene, &sphere, grid.spacing_m, i, gather, out);
    sample_emitters(scene, &sphere, out);
    finish_sh(out->sky, 1);
    for (int c = 0; c < 3; c++) finish_sh(&out->emitted[0][c], 3);
}
