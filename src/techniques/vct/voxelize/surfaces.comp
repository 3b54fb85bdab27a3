// From the sums over triangles to surface attributes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vct/voxelize/voxelize_shared.h"
#include "techniques/vct/voxelize/surface.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 0, scalar) readonly buffer vct_arguments
{
    vct_voxel_counts counts;
};
layout(set = 0, binding = 1, scalar) readonly buffer vct_accumulated_list
{
    uint accumulated_list[];
};
layout(set = 0, binding = 2, scalar) readonly buffer vct_sum_words
{
    uint sums[];
};
layout(set = 0, binding = 3, rgba32ui) uniform writeonly uimage2D vct_surfaces;

uvec3 three(uint at)
{
    return uvec3(sums[at], sums[at + 1u], sums[at + 2u]);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= counts.accumulated) return;
    uint slot = accumulated_list[i], at = slot * VCT_SUM_WORDS;
    vct_sums s;
    s.weight = sums[at + VCT_SUM_WEIGHT];
    s.opacity = sums[at + VCT_SUM_OPACITY];
    s.reflectance = three(at + VCT_SUM_REFLECTANCE);
    s.normal = ivec3(three(at + VCT_SUM_NORMAL));
    s.position = ivec3(three(at + VCT_SUM_POSITION));
    s.emission = three(at + VCT_SUM_EMISSION);
    s.covered = sums[at + VCT_SUM_COVERED];
    s.lines = sums[at + VCT_SUM_LINES];
    uvec4 first, second;
    vct_pack_sums(s, first, second);
    ivec2 to = vct_surface_texel(slot);
    imageStore(vct_surfaces, to, first);
    imageStore(vct_surfaces, to + ivec2(1, 0), second);
}
