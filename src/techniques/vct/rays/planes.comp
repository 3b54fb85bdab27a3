// Planes of the faces of a set, for rays.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/rays/plane.glsl"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/voxelize/line_places.glsl"
#include "techniques/vct/voxelize/surface.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer vct_arguments
{
    vct_voxel_counts counts;
};
layout(set = 0, binding = 2) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 3, rg32ui) uniform writeonly uimage2D vct_planes;

const float HEIGHT_ROUNDING = 1.0 / 64.0; // of a plane on the voxel's border, in voxels

// Columns and rows of sample lines: those on which the surfaces are, grown up to lines on which the
// plane is within the voxel but no surface.
struct plane_extent {
    uvec2 first, last;
    uint lines; // within it, on which the plane is within the voxel
};

// Height of a plane above the voxel's centre on a line, along the dominant axis of its normal.
float height_on(uvec2 place, vec3 normal, float distance)
{
    vec2 at = (vec2(place) + 0.5) / float(VCT_LINES) - 0.5;
    vec3 size = abs(normal);
    uint axis = size.x >= max(size.y, size.z) ? 0u : size.y >= size.z ? 1u : 2u;
    return (distance - dot(vct_across(normal, 2u * axis), at)) / normal[axis];
}

bool is_between(uint value, uint first, uint last)
{
    return value >= first && value <= last;
}

// The nearest bare lines on both sides of the extent along one of its axes bound it.
void grow(inout plane_extent e, uint along, uint bare)
{
    uint across = 1u - along;
    ivec2 bounds = ivec2(-1, VCT_LINES);
    for (uint i = 0u; i < VCT_LINES; i++) {
        uvec2 place = vct_line_place(i);
        bool blocks =
            (bare >> i & 1u) != 0u && is_between(place[across], e.first[across], e.last[across]);
        int at = int(place[along]);
        if (blocks && at < int(e.first[along])) bounds.x = max(bounds.x, at);
        if (blocks && at > int(e.last[along])) bounds.y = min(bounds.y, at);
    }
    e.first[along] = uint(bounds.x + 1);
    e.last[along] = uint(bounds.y - 1);
}

// lines: on which the surfaces are, as bits; at least one.
plane_extent extent_of(uint lines, vec3 normal, float distance)
{
    plane_extent e = plane_extent(uvec2(VCT_LINES), uvec2(0u), 0u);
    uint within = 0u;
    for (uint i = 0u; i < VCT_LINES; i++) {
        uvec2 place = vct_line_place(i);
        if (abs(height_on(place, normal, distance)) <= 0.5 + HEIGHT_ROUNDING) within |= 1u << i;
        if ((lines >> i & 1u) == 0u) continue;
        e.first = min(e.first, place);
        e.last = max(e.last, place);
    }
    grow(e, 0u, within & ~lines);
    grow(e, 1u, within & ~lines);
    for (uint i = 0u; i < VCT_LINES; i++) {
        uvec2 place = vct_line_place(i);
        if (is_between(place.x, e.first.x, e.last.x) && is_between(place.y, e.first.y, e.last.y))
            e.lines += within >> i & 1u;
    }
    return e;
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
    plane_extent e = extent_of(s.lines, normal, distance);
    float opacity = s.covers ? s.opacity * float(VCT_LINES) / float(max(e.lines, 1u)) : 0.0;
    uint bits = code.x | code.y << 8 | uint(roundEven((distance + 1.0) * 511.0)) << 16 |
                uint(roundEven(clamp(opacity, 0.0, 1.0) * 63.0)) << 26;
    uint extent = e.first.x | e.first.y << 4 | e.last.x << 8 | e.last.y << 12;
    imageStore(vct_planes, vct_face_texel(vct.face_first + slot), uvec4(bits, extent, 0u, 0u));
}
