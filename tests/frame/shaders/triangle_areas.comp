#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Totals of a draw's triangles: count, count of solid centroids, and area in 1/1024 m². Integer
// sums do not depend on the order.
#include "frame/scene/scene_triangles.glsl"

layout(local_size_x = SCENE_TRIANGLES_LOCAL) in;

layout(set = 0, binding = 12, scalar) buffer totals
{
    uint total[];
};

void main()
{
    if (gl_GlobalInvocationID.x >= push.triangle_count) return;
    uvec3 vertices = scene_triangle(gl_GlobalInvocationID.x);
    mat3 corners = scene_triangle_positions(vertices);
    float area = 0.5 * length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    atomicAdd(total[0], 1u);
    if (scene_triangle_solid(vertices, vec3(1.0 / 3.0))) atomicAdd(total[1], 1u);
    atomicAdd(total[2], uint(round(1024.0 * area)));
}
