// Takes one source's surfels into the geometry volume: at each corner the source that saw most
// stays. Several that see the same surface would count it as often as they see it; so there is no
// sum.
//
// A greatest vector of coefficients: the one with the greatest first coefficient, Y00 Σ A/S² π/4π…,
// that is the greatest area, as a whole. The greatest of each coefficient by itself would be a
// surface that nobody saw. Equal areas are decided by the other coefficients in order, after
// rounding to what is stored: so no order of the sources changes a bit.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#define LPV_SURFELS_BINDING 1
#include "techniques/lpv/geometry/geometry_surfels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, rgba16f) uniform image3D geometry;

bool greater(vec4 a, vec4 b)
{
    for (int i = 0; i < 4; i++)
        if (a[i] != b[i]) return a[i] > b[i];
    return false;
}

void main()
{
    ivec3 corner = ivec3(gl_GlobalInvocationID);
    if (!lpv_inside(corner)) return;
    int at = 4 * lpv_index(corner);
    vec4 seen =
        vec4(surfel_sums[at], surfel_sums[at + 1], surfel_sums[at + 2], surfel_sums[at + 3]) /
        LPV_SURFEL_FIXED;
    seen = vec4(unpackHalf2x16(packHalf2x16(seen.xy)), unpackHalf2x16(packHalf2x16(seen.zw)));
    if (greater(seen, imageLoad(geometry, corner))) imageStore(geometry, corner, seen);
}
