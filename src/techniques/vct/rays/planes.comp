// Planes of the faces of a set, for rays.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/rays/plane.glsl"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/surface.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer vct_arguments
{
    vct_voxel_counts counts;
};
layout(set = 0, binding = 2) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 3, r32ui) uniform writeonly uimage2D vct_planes;

// Probability that the sum of two uniform variables of mean 0 and widths a and b is less than u.
float two_widths(vec2 width, float u)
{
    vec4 ends = max(
        u + 0.5 * vec4(width.x + width.y, width.x - width.y, width.y - width.x, -width.x - width.y),
        vec4(0.0));
    ends *= ends;
    return (ends.x - ends.y - ends.z + ends.w) / (2.0 * width.x * width.y);
}

// Share of the columns of a voxel, along the dominant axis of the normal, in which a plane is
// within the voxel.
float plane_coverage(vec3 normal, float distance)
{
    vec3 size = abs(normal);
    float most = max(size.x, max(size.y, size.z)), height = abs(distance) / most;
    vec2 others = size.x == most ? size.yz : size.y == most ? size.xz : size.xy;
    vec2 width = max(others / most, vec2(0.02));
    return two_widths(width, height + 0.5) - two_widths(width, height - 0.5);
}

uvec2 octahedron_code(vec3 normal)
{
    return uvec2(roundEven((octahedral_encode(normal) + 1.0) * 127.0)); // along axes exact
}

void main()
{
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= counts.listed) return;
    vct_surface s = vct_unpack_surface(texelFetch(vct_surfaces, vct_surface_texel(slot), 0));
    uvec2 code = octahedron_code(s.normal);
    vec3 normal = vct_octahedron(code);
    float distance = clamp(dot(normal, s.position), -1.0, 1.0);
    // Coverage is stored for whole columns; the lines that measure it are half a line off at most.
    float covered = plane_coverage(normal, distance);
    float opacity =
        s.covers ? (s.opacity + 0.5 / float(VCT_LINES)) / max(covered, 1.0 / 64.0) : 0.0;
    uint bits = code.x | code.y << 8 | uint(roundEven((distance + 1.0) * 511.0)) << 16 |
                uint(roundEven(clamp(opacity, 0.0, 1.0) * 63.0)) << 26;
    imageStore(vct_planes, vct_face_texel(slot), uvec4(bits, 0u, 0u, 0u));
}
