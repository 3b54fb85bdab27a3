// Places of lookups in the bricks of probes. Needs locate.glsl, MRT_BRICKS_BINDING and
// MRT_SIGHT_BINDING.
#ifndef AG_MRT_BRICKS_GLSL
#define AG_MRT_BRICKS_GLSL

#include "techniques/mrt/gpu/tube.glsl"

layout(constant_id = MRT_CONSTANT_SIGHT) const int SIGHT = 0;

layout(set = 0, binding = MRT_BRICKS_BINDING) uniform sampler3D bricks;
layout(set = 0, binding = MRT_SIGHT_BINDING) readonly buffer mrt_probe_sight
{
    uint sight_table[]; // mrt_operators.sight
};

// In texels of the first slab, moved by `ahead` of them. Places outside the cell are clamped to the
// brick's border.
vec3 brick_texel(mrt_place place, vec3 ahead)
{
    int edge = int(level.probes) + 2, block = place.block;
    vec3 unit = TUBES ? tube_unit(block, place.cell) : place.cell + 0.5;
    vec3 at = unit * float(level.probes) + 1.0 + ahead;
    ivec3 brick = ivec3(block % int(level.brick_columns), block / int(level.brick_columns), 0);
    return vec3(brick * edge) + clamp(at, vec3(0.5), vec3(float(edge) - 0.5));
}

// Probes behind a surface, in an object or beyond a wall, have other light. Where it is unknown
// which are visible, lookups are moved along the normal by this share of the distance of probes.
const float MRT_AHEAD = 0.3;

// Lookups of a place at the probes visible from it past clutter (objects/delta.h).
struct mrt_visible_probes {
    vec3 texel;
    uint probes; // bits
    int lookups; // 1: between all probes, or 8: at each of them
    float scale; // of their light
};

ivec3 voxel_at(vec3 at)
{
    return clamp(ivec3(floor(at)), ivec3(0), ivec3(SIGHT - 1));
}

uint sight_at(uint first, ivec3 v)
{
    return sight_table[first + uint((v.z * SIGHT + v.y) * SIGHT + v.x)];
}

// The lowest of the eight probes around a voxel, as voxel_of of objects/probe_sight.c.
ivec3 probe_below(ivec3 voxel)
{
    return (voxel * int(level.probes) + SIGHT / 2) / SIGHT;
}

// Bits of the probes around one voxel as those around another, whose lowest probe is `by` further.
// Probes that only the latter has are 0.
uint probes_from(uint bits, ivec3 by)
{
    const uint LOW[3] = { 0x55u, 0x33u, 0x0fu }; // of the lower four along an axis
    for (int a = 0; a < 3; a++) {
        uint up = bits >> (1 << a) & LOW[a], down = (bits & LOW[a]) << (1 << a);
        bits = by[a] == 0 ? bits : by[a] > 0 ? up : down;
    }
    return bits;
}

// The voxel one step from a surface along its normal, in the cell, is entirely on its side, but may
// be in another object, and beyond the plane of some of the probes around the surface. The
// surface's own voxel, which its wall may cross, then counts, too.
uint sight_of(mrt_place place, vec3 normal)
{
    uint first = sight_table[place.block];
    if (first == 0u) return MRT_SIGHT_PROBES;
    vec3 at = (place.cell + 0.5) * float(SIGHT);
    ivec3 here = voxel_at(at);
    uint own = sight_at(first, here);
    if (normal == vec3(0.0)) return own;
    ivec3 next = voxel_at(at + normal / largest_of(normal));
    ivec3 by = probe_below(here) - probe_below(next);
    uint sight = sight_at(first, next), known = probes_from(MRT_SIGHT_PROBES, by);
    uint seen = probes_from(sight & MRT_SIGHT_PROBES, by) | own & MRT_SIGHT_PROBES & ~known;
    bool solid = (sight & MRT_SIGHT_SOLID) != 0u;
    if (solid) seen &= own;
    if (seen != 0u) return seen;
    return solid || (sight & MRT_SIGHT_PROBES) != 0u ? own : sight;
}

// In a plane of probes, and beyond the brick, those beside it may be the only ones visible.
const float MRT_LEAST_SHARE = 1e-3;

float share_of_probe(mrt_visible_probes visible, int c)
{
    vec3 t = fract(visible.texel - 0.5);
    vec3 w = max(mix(1.0 - t, t, vec3(c & 1, c >> 1 & 1, c >> 2 & 1)), MRT_LEAST_SHARE);
    return float(visible.probes >> uint(c) & 1u) * w.x * w.y * w.z;
}

// normal: in the cell, 0 of a point in space.
mrt_visible_probes visible_probes_at(mrt_place place, vec3 normal)
{
    bool clear = !TUBES && (SIGHT == 0 || sight_table[place.block] == 0u);
    vec3 ahead = clear ? MRT_AHEAD * normal : vec3(0.0);
    mrt_visible_probes visible =
        mrt_visible_probes(brick_texel(place, ahead), MRT_SIGHT_PROBES, 1, 1.0);
    if (SIGHT == 0) return visible;
    uint sight = sight_of(place, normal);
    visible.probes = sight & MRT_SIGHT_PROBES;
    float sum = 0.0;
    for (int c = 0; c < 8; c++) sum += share_of_probe(visible, c);
    bool none = visible.probes == 0u, some = !none && visible.probes != MRT_SIGHT_PROBES;
    visible.lookups = some ? 8 : 1;
    visible.scale = some ? 1.0 / sum : none ? float(sight >> MRT_SIGHT_OPEN & 255u) / 255.0 : 1.0;
    return visible;
}

// Lookup i, and its weight. A loop of as many lookups costs software drivers less than branches.
vec3 lookup_of(mrt_visible_probes visible, int i, out float weight)
{
    bool all = visible.lookups == 1;
    weight = visible.scale * (all ? 1.0 : share_of_probe(visible, i));
    return all ? visible.texel
               : floor(visible.texel - 0.5) + vec3(i & 1, i >> 1 & 1, i >> 2 & 1) + 0.5;
}

#endif
