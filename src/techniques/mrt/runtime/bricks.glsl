// Lookups in the bricks of probes. Needs locate.glsl, core/sh.glsl, frame/probes.glsl and
// MRT_BRICKS_BINDING.
#ifndef AG_MRT_BRICKS_GLSL
#define AG_MRT_BRICKS_GLSL

#include "techniques/mrt/runtime/tube.glsl"

layout(set = 0, binding = MRT_BRICKS_BINDING) uniform sampler3D bricks;

// In texels of the first slab. Places outside the cell are clamped to the brick's border.
vec3 brick_texel(mrt_place place)
{
    int edge = int(level.probes) + 2, block = place.block;
    vec3 unit = TUBES ? tube_unit(block, place.cell) : place.cell + 0.5;
    vec3 at = unit * float(level.probes) + 1.0;
    ivec3 brick = ivec3(block % int(level.brick_columns), block / int(level.brick_columns), 0);
    return vec3(brick * edge) + clamp(at, vec3(0.5), vec3(float(edge) - 0.5));
}

vec3 bricks_irradiance(mrt_place place, vec3 normal)
{
    return probes_irradiance_at(bricks, int(level.probes) + 2, brick_texel(place), normal);
}

#endif
