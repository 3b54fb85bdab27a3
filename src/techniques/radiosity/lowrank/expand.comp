// Light of each texel: the modes of its region, the sky and emissive surfaces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#if SUBGROUPS
#extension GL_KHR_shader_subgroup_ballot : require
#endif
#define RADIOSITY_TEXELS_BINDING 1
#define RADIOSITY_LIGHT_BINDING  6
#include "frame/frame.glsl"
#include "techniques/radiosity/lowrank/lowrank_shared.h"
#include "techniques/radiosity/radiosity_receive.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_expand_push push;
};
layout(set = 0, binding = 2) uniform usampler2D radiosity_order; // [row] texel
layout(set = 0, binding = 3, scalar) readonly buffer radiosity_regions
{
    uvec4 region_table[];
};
// [tuple of modes][component][row of a tile], halves
layout(set = 0, binding = 4, rgba32ui) uniform readonly uimage2D radiosity_expansions;
layout(set = 0, binding = 5, scalar) readonly buffer radiosity_modes
{
    vec3 mode_table[];
};

radiosity_received sum = radiosity_received(vec3(0.0), vec3(0.0), vec3(0.0));

// The mode of this invocation, of the tuple from `first` on; in a subgroup all are there.
vec3 mode_of(uint first)
{
#if SUBGROUPS
    return mode_table[first + gl_SubgroupInvocationID % RADIOSITY_MODES];
#else
    return vec3(0.0);
#endif
}

// Mode k of the tuple from `first` on. Invocations of a workgroup read the same ones.
vec3 light_of(uint first, vec3 own, uint k)
{
#if SUBGROUPS
    return subgroupBroadcast(own, k);
#else
    return mode_table[first + k];
#endif
}

void main()
{
    // A workgroup has rows of one region, and no invocation ends before the loads of modes.
    uint group = push.first + gl_WorkGroupID.x * RADIOSITY_LOCAL;
    uint row = push.first + gl_GlobalInvocationID.x;
    uvec4 region = region_table[group / RADIOSITY_REGION];
    uint tuples = region.w & ((1u << RADIOSITY_REGION_SHIFT) - 1u);
    uint first = region.z / RADIOSITY_MODES * 3 * RADIOSITY_REGION +
                 row % RADIOSITY_REGION / RADIOSITY_TILE * RADIOSITY_TILE * 3 * tuples +
                 row % RADIOSITY_TILE;
    for (uint t = 0; t < tuples; t++) {
        uint at = first + 3 * RADIOSITY_TILE * t;
        uvec4 e = imageLoad(radiosity_expansions, radiosity_at(at));
        uvec4 u = imageLoad(radiosity_expansions, radiosity_at(at + RADIOSITY_TILE));
        uvec4 v = imageLoad(radiosity_expansions, radiosity_at(at + 2 * RADIOSITY_TILE));
        uint mode = region.z + RADIOSITY_MODES * t;
        vec3 own = mode_of(mode);
        for (uint k = 0; k < RADIOSITY_MODES; k++) {
            vec3 light = light_of(mode, own, k);
            sum.irradiance += unpackHalf2x16(e[k / 2])[k % 2] * light;
            sum.by_u += unpackHalf2x16(u[k / 2])[k % 2] * light;
            sum.by_v += unpackHalf2x16(v[k / 2])[k % 2] * light;
        }
    }
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = texelFetch(radiosity_order, radiosity_at(row), 0).x;
    radiosity_store_light(i, push.texels, sum, push.emitters * frame.radiance_scale);
}
