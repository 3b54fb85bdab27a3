// Merges the surfels of one source into the geometry volume by the maximum. A sum would count a
// surface that several sources see several times.
//
// The maximum of two lobes is the one with the greater first coefficient, that is the greater area,
// as a whole: a maximum per coefficient would be a surface that does not exist. Ties are decided by
// the other coefficients in order, after rounding to the stored precision, so that the order of
// the sources does not change a bit.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#define LPV_SURFELS_BINDING 1
#include "techniques/lpv/geometry/geometry_surfels.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 2, rgba16f) uniform image3D geometry;

bool greater(vec4 a, vec4 b)
{
    for (int i = 0; i < 4; i++)
        if (a[i] != b[i]) return a[i] > b[i];
    return false;
}

void main()
{
    ivec3 corner = lpv_cell_of_invocation(1);
    if (!lpv_inside(corner)) return;
    int at = 4 * lpv_index(corner);
    vec4 source;
    for (int i = 0; i < 4; i++)
        source[i] = half_rounded(float(surfel_sums[at + i]) / LPV_SURFEL_FIXED);
    if (greater(source, imageLoad(geometry, corner))) imageStore(geometry, corner, source);
}
