// Coverage masks to the geometry volume: the covered fraction of each cell's low faces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer lpv_static_coverage
{
    uint static_masks[]; // [cell][axis]
};
layout(set = 0, binding = 2, scalar) readonly buffer lpv_moving_coverage
{
    uint moving_masks[];
};
layout(set = 0, binding = 3, rgba16f) uniform writeonly image3D geometry;

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (!lpv_inside(cell)) return;
    int at = 3 * lpv_index(cell);
    vec3 covered = vec3(0.0);
    for (int axis = 0; axis < 3; axis++)
        covered[axis] = float(bitCount(static_masks[at + axis] | moving_masks[at + axis])) /
                        float(LPV_LINES * LPV_LINES);
    imageStore(geometry, cell, vec4(covered, 0.0));
}
