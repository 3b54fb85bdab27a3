// Irradiance between probes, of which some may be behind walls. The weight of a probe is its
// visibility from the surface, estimated from mean and variance of the probe's depths by
// Chebyshev's inequality (Majercik et al. 2019, "Dynamic Diffuse Global Illumination with
// Ray-Traced Irradiance Fields").
//
// Depths are stored as nearness 1/|v|₁, with the L1 norm of an offset v. On a plane, nearness is a
// linear function of the place in a face of the octahedral map. The map has points at the corners
// of cells, and cells are cut along the edges of the octahedron: interpolation in triangles is
// exact on a plane, in all directions. The deviation is that of other rays from the interpolated
// map. Euclidean distances of a plane at a grazing angle vary within a cell by more than a wall's
// thickness.
//
// The volume is that of frame/probes.glsl with one slab more: of each probe its offset from the
// grid, in spacings, and 1, or 0 where it has no light of its own. `depth`: RG16F, a tile for each
// probe, nearness and its standard deviation, in 1/spacing: an octahedral map
// (frame/octahedral.glsl) of PROBE_DEPTH_TILE² points. Include after
// core/sh.glsl, frame/frame_shared.h, frame/octahedral.glsl and frame/probes.glsl.
#ifndef AG_PROBES_LOOKUP_GLSL
#define AG_PROBES_LOOKUP_GLSL

#include "techniques/common/probes/depth_shared.h"

const float PROBE_BIAS = 0.05; // spacings along the normal, against the variance of planes

vec2 probe_depth(sampler2D depth, int probe, vec3 direction)
{
    int columns = textureSize(depth, 0).x / PROBE_DEPTH_TILE;
    ivec2 tile = PROBE_DEPTH_TILE * ivec2(probe % columns, probe / columns);
    vec2 at = (0.5 * octahedral_encode(direction) + 0.5) * float(PROBE_DEPTH_SIDE);
    ivec2 near = min(ivec2(at), ivec2(PROBE_DEPTH_SIDE - 1)), far = near + 1;
    vec2 share = at - vec2(near);
    bvec2 low = lessThan(near, ivec2(PROBE_DEPTH_SIDE / 2));
    if (low.x != low.y) {
        share.x = 1.0 - share.x;
        near.x++;
        far.x--;
    }
    bool beyond = share.x + share.y > 1.0;
    vec2 other = beyond ? 1.0 - share.yx : share;
    return (1.0 - other.x - other.y) * texelFetch(depth, tile + (beyond ? far : near), 0).rg +
           other.x * texelFetch(depth, tile + ivec2(far.x, near.y), 0).rg +
           other.y * texelFetch(depth, tile + ivec2(near.x, far.y), 0).rg;
}

// to: from the probe, in spacings.
float probe_visibility(sampler2D depth, int probe, vec3 to)
{
    float way = dot(abs(to), vec3(1.0));
    if (way < 1.0 / PROBE_NEAR) return 1.0;
    vec2 moments = probe_depth(depth, probe, to);
    float beyond = moments.x - max(1.0 / way, PROBE_FAR);
    if (beyond <= 0.0) return 1.0;
    float deviation = max(moments.y, PROBE_SPREAD * moments.x);
    float bound = deviation * deviation / (deviation * deviation + beyond * beyond);
    float hidden = clamp(beyond / (PROBE_ERROR * moments.x) - 1.0, 0.0, 1.0);
    return bound * bound * bound * (1.0 - hidden);
}

// One of the eight probes around a place.
struct probe_corner {
    ivec3 cell;
    vec3 to;          // from the probe to the place, in spacings
    float linear;     // share of the interpolation
    float visibility; // 0: it has no light of its own, or is behind a wall
};

// at: in spacings of the grid, at most half of one outside.
probe_corner probe_corner_of(sampler3D volume, sampler2D depth, frame_probes grid, vec3 at, int i)
{
    ivec3 last = ivec3(grid.count_x, grid.count_y, grid.count_z) - 1;
    ivec3 base = ivec3(floor(at)), step = ivec3(i & 1, i >> 1 & 1, i >> 2);
    ivec3 cell = clamp(base + step, ivec3(0), last);
    vec3 linear = mix(1.0 - (at - vec3(base)), at - vec3(base), equal(step, ivec3(1)));
    vec4 place = texelFetch(volume, cell + ivec3(0, 0, FRAME_PROBE_SLABS * grid.slab), 0);
    vec3 to = at - vec3(cell) - place.xyz;
    int probe = (cell.z * grid.count_y + cell.y) * grid.count_x + cell.x;
    return probe_corner(cell, to, linear.x * linear.y * linear.z,
                        place.w * probe_visibility(depth, probe, to));
}

// Probes in front of the surface count more than those behind it. to: from the probe.
float probe_facing(vec3 normal, vec3 to)
{
    float facing = 0.5 - 0.5 * dot(normal, to) / max(length(to), 1e-4);
    return facing * facing + 0.2;
}

// Negative where the coefficients ring.
vec3 probe_sum(sampler3D volume, int slab, ivec3 cell, float basis[9])
{
    vec4 values;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 27; i++) {
        if (i % 4 == 0) values = texelFetch(volume, cell + ivec3(0, 0, i / 4 * slab), 0);
        sum[i % 3] += basis[i / 3] * values[i % 4];
    }
    return sum;
}

vec3 probe_irradiance(sampler3D volume, int slab, ivec3 cell, float basis[9])
{
    return max(probe_sum(volume, slab, cell, basis), vec3(0.0));
}

// Irradiance by direction, at a point of a surface in the world; points beyond the grid are moved
// to its cells.
vec3 probes_visible_irradiance(sampler3D volume, sampler2D depth, frame_probes grid, vec3 position,
                               vec3 normal, vec3 direction)
{
    vec3 at = (position - grid.first_m) / grid.spacing_m + PROBE_BIAS * normal;
    at = clamp(at, vec3(-0.5), vec3(grid.count_x, grid.count_y, grid.count_z) - 0.5);
    float basis[9];
    sh9_eval(direction, basis);
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 8; i++) {
        probe_corner corner = probe_corner_of(volume, depth, grid, at, i);
        float weight =
            corner.linear * (corner.visibility * probe_facing(normal, corner.to) + PROBE_OCCLUDED);
        sum += weight * probe_irradiance(volume, grid.slab, corner.cell, basis);
        weights += weight;
    }
    return sum / weights;
}

// Irradiance over directions, as coefficients, at a point that is on no surface.
void probes_visible_coefficients(sampler3D volume, sampler2D depth, frame_probes grid,
                                 vec3 position, out vec3 c[9])
{
    vec3 last = vec3(grid.count_x, grid.count_y, grid.count_z) - 1.0;
    vec3 at = clamp((position - grid.first_m) / grid.spacing_m, vec3(0.0), last);
    float weights = 0.0;
    for (int j = 0; j < 9; j++) c[j] = vec3(0.0);
    for (int k = 0; k < 8; k++) {
        probe_corner corner = probe_corner_of(volume, depth, grid, at, k);
        float weight = corner.linear * (corner.visibility + PROBE_OCCLUDED);
        vec4 values;
        for (int i = 0; i < 27; i++) {
            if (i % 4 == 0)
                values = texelFetch(volume, corner.cell + ivec3(0, 0, i / 4 * grid.slab), 0);
            c[i / 3][i % 3] += weight * values[i % 4];
        }
        weights += weight;
    }
    for (int j = 0; j < 9; j++) c[j] /= weights;
}

// ---- for shaders of a program

// The place of a lookup, in spacings of the grid, moved towards the probes on its side of the walls
// around it: a surface between two probes removes its covered share of the weight of the one beyond
// it. Of each probe, slab FRAME_PROBE_SLABS has the shares of the intervals to its lower neighbours
// along x, y and z, the next slab the surfaces' places there. The second round over the axes knows
// on which side of all walls the place is.
vec3 probes_before_walls(sampler3D volume, frame_probes grid, vec3 at)
{
    ivec3 counts = ivec3(grid.count_x, grid.count_y, grid.count_z), own = ivec3(floor(at + 0.5));
    vec3 result = at;
    for (int i = 0; i < 6; i++) {
        int axis = i % 3;
        float low = floor(at[axis]), share = at[axis] - low;
        ivec3 cell = own;
        cell[axis] = int(low) + 1;
        if (cell[axis] >= counts[axis]) continue;
        cell.z += FRAME_PROBE_SLABS * grid.slab;
        float covered = texelFetch(volume, cell, 0)[axis];
        bool above = share > texelFetch(volume, cell + ivec3(0, 0, grid.slab), 0)[axis];
        result[axis] =
            low + (above ? 1.0 - (1.0 - share) * (1.0 - covered) : share * (1.0 - covered));
        if (covered > 0.0) own[axis] = int(low) + (above ? 1 : 0);
    }
    return result;
}

// With the weights of interpolation and visibility alone. Points beyond the grid are moved to its
// cells.
vec3 probes_seen_irradiance(sampler3D volume, sampler2D depth, frame_probes grid, vec3 position,
                            vec3 normal)
{
    vec3 counts = vec3(grid.count_x, grid.count_y, grid.count_z);
    vec3 at = clamp((position - grid.first_m) / grid.spacing_m, vec3(-0.5), counts - 0.5);
    float basis[9], weights = 0.0;
    sh9_eval(normal, basis);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 8; k++) {
        probe_corner corner = probe_corner_of(volume, depth, grid, at, k);
        float weight = corner.linear * (corner.visibility + PROBE_OCCLUDED);
        sum += weight * probe_sum(volume, grid.slab, corner.cell, basis);
        weights += weight;
    }
    return max(sum / weights, vec3(0.0));
}

// Irradiance at a world position for a unit normal, as ag_probes_irradiance has it, times the scale
// of struct ag_probes_handle. visibility: of that struct; it also has `grid` and both images, which
// have linear filters and clamped coordinates. Without depths any image may be in their place.
vec3 probes_published_irradiance(sampler3D volume, sampler2D depth, frame_probes grid,
                                 int visibility, vec3 position, vec3 normal)
{
    if (visibility == PROBE_VISIBILITY_DEPTHS)
        return probes_seen_irradiance(volume, depth, grid, position, normal);
    vec3 last = vec3(grid.count_x, grid.count_y, grid.count_z) - 1.0;
    vec3 at = clamp((position - grid.first_m) / grid.spacing_m, vec3(0.0), last);
    if (visibility == PROBE_VISIBILITY_WALLS) at = probes_before_walls(volume, grid, at);
    return probes_irradiance_at(volume, grid.slab, at + 0.5, normal);
}

#endif
