// Lookups between probes in host memory: lookup.glsl has the same functions and the reasons.
#include "techniques/common/probes/copy.h"

#include "core/sh.h"
#include "techniques/common/probes/depth_map.h"

#include <math.h>

static void counts_of(struct frame_probes grid, int out[3])
{
    out[0] = grid.count_x;
    out[1] = grid.count_y;
    out[2] = grid.count_z;
}

static size_t probe_of(const int counts[3], const int cell[3])
{
    return ((size_t)cell[2] * (size_t)counts[1] + (size_t)cell[1]) * (size_t)counts[0] +
           (size_t)cell[0];
}

// ---- what probes see

static vec2s depth_of(const float *tile, vec3s direction)
{
    const struct probe_depth_place place = probe_depth_place_of(direction);
    vec2s out = { { 0, 0 } };
    for (int k = 0; k < 3; k++) {
        out.x += place.weight[k] * tile[2 * place.point[k]];
        out.y += place.weight[k] * tile[2 * place.point[k] + 1];
    }
    return out;
}

// to: from the probe, in spacings.
static float visibility_of(const float *tile, vec3s to)
{
    const float way = glms_vec3_norm_one(to);
    if (way < 1.0f / PROBE_NEAR) return 1.0f;
    const vec2s depth = depth_of(tile, to);
    const float beyond = depth.x - fmaxf(1.0f / way, PROBE_FAR);
    if (beyond <= 0.0f) return 1.0f;
    const float deviation = fmaxf(depth.y, PROBE_SPREAD * depth.x),
                variance = deviation * deviation;
    const float bound = variance / (variance + beyond * beyond);
    const float hidden = fminf(fmaxf(beyond / (PROBE_ERROR * depth.x) - 1.0f, 0.0f), 1.0f);
    return bound * bound * bound * (1.0f - hidden);
}

// One of the eight probes around a place.
struct corner {
    size_t probe;
    float weight;
};

static struct corner corner_of(const struct probe_copy *copy, const float at[3], int i)
{
    struct corner out = { 0, 1.0f };
    vec3s to;
    int counts[3], cell[3];
    counts_of(copy->grid, counts);
    for (int a = 0; a < 3; a++) {
        const float low = floorf(at[a]), share = at[a] - low;
        const int high = i >> a & 1, place = (int)low + high;
        cell[a] = place < 0 ? 0 : place < counts[a] ? place : counts[a] - 1;
        out.weight *= high ? share : 1.0f - share;
        to.raw[a] = at[a] - (float)cell[a];
    }
    out.probe = probe_of(counts, cell);
    if (copy->visibility != PROBE_VISIBILITY_DEPTHS) return out;
    const float *offset = copy->offsets + 4 * out.probe;
    for (int a = 0; a < 3; a++) to.raw[a] -= offset[a];
    const float *tile = copy->depths + 2 * PROBE_DEPTHS * out.probe;
    out.weight *= offset[3] * visibility_of(tile, to) + PROBE_OCCLUDED;
    return out;
}

// ---- walls between probes

// Moves a place towards the probes on its side of the walls around it.
static void keep_before_walls(const struct probe_copy *copy, float at[3])
{
    const float place[3] = { at[0], at[1], at[2] };
    int counts[3], own[3];
    counts_of(copy->grid, counts);
    for (int a = 0; a < 3; a++) own[a] = (int)floorf(place[a] + 0.5f);
    for (int i = 0; i < 6; i++) {
        const int a = i % 3;
        const float low = floorf(place[a]), share = place[a] - low;
        int cell[3] = { own[0], own[1], own[2] };
        cell[a] = (int)low + 1;
        if (cell[a] >= counts[a]) continue;
        const float *wall = copy->walls + 6 * probe_of(counts, cell) + 2 * a;
        const bool above = share > wall[1];
        at[a] = low + (above ? 1.0f - (1.0f - share) * (1.0f - wall[0]) : share * (1.0f - wall[0]));
        if (wall[0] > 0.0f) own[a] = (int)low + (above ? 1 : 0);
    }
}

// ---- lookups

static void place_of(const struct probe_copy *copy, vec3s position, float out[3])
{
    const bool depths = copy->visibility == PROBE_VISIBILITY_DEPTHS;
    const float beyond = depths ? 0.5f : 0.0f;
    int counts[3];
    counts_of(copy->grid, counts);
    for (int a = 0; a < 3; a++) {
        const float at = (position.raw[a] - copy->grid.first_m.raw[a]) / copy->grid.spacing_m;
        const float last = (float)(counts[a] - 1) + beyond;
        out[a] = at > -beyond ? fminf(at, last) : -beyond; // NaN too
    }
    if (copy->visibility == PROBE_VISIBILITY_WALLS) keep_before_walls(copy, out);
}

void probe_copy_irradiance(const struct probe_copy *copy, vec3s position, vec3s normal,
                           float out[3])
{
    float at[3], basis[9], sum[3] = { 0 }, weights = 0.0f;
    place_of(copy, position, at);
    sh_eval(3, normal, basis);
    for (int i = 0; i < 8; i++) {
        const struct corner corner = corner_of(copy, at, i);
        const float *c = copy->coefficients + 27 * corner.probe;
        for (int k = 0; k < 27; k++) sum[k % 3] += corner.weight * basis[k / 3] * c[k];
        weights += corner.weight;
    }
    for (int c = 0; c < 3; c++) out[c] = fmaxf(sum[c] / weights, 0.0f);
}
