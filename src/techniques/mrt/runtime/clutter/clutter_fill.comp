// The light map of clutter, in the atlas of its charts: the texels' own, and those of gutters and
// of texels inside objects, which have others' light. A layer for each of red, green, blue.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "techniques/mrt/mrt_shared.h"

layout(local_size_x = MRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    mrt_clutter_fill_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer mrt_clutter_sources
{
    uvec2 source_table[]; // in light_table, in unbounced_table; ~0: no surface
};
layout(set = 0, binding = 1, scalar) readonly buffer mrt_clutter_light
{
    vec3 light_table[]; // [texel][4]
};
layout(set = 0, binding = 2, scalar) readonly buffer mrt_unbounced
{
    vec3 unbounced_table[]; // irradiance of emissive surfaces and the sky
};
layout(set = 0, binding = 3, rgba16f) writeonly uniform image2DArray clutter_map;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.texels) return;
    uvec2 source = source_table[i];
    for (int c = 0; c < 3; c++) {
        vec4 texel = vec4(0.0);
        if (source.x != ~0u) {
            for (uint v = 0u; v < 4u; v++) texel[v] = light_table[source.x * 4u + v][c];
            texel.x += unbounced_table[source.y][c] / SH_Y0;
        }
        imageStore(clutter_map, ivec3(i % push.width, i / push.width, c),
                   clamp(texel, -HALF_MAX, HALF_MAX));
    }
}
