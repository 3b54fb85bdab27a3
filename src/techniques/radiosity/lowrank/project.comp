// Modes of a region: weighted sums of the radiosities of its sources, which signed integers of 16
// bits weigh. Invocations share the sources, then the modes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/lowrank/lowrank_shared.h"
#include "techniques/radiosity/radiosity_table.glsl"

layout(local_size_x = RADIOSITY_PROJECT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_project_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_regions
{
    uvec4 region_table[];
};
layout(set = 0, binding = 1) uniform usampler2D radiosity_sources; // nodes
// [tuple of sources][tuple of modes][source]
layout(set = 0, binding = 2, rgba32ui) uniform readonly uimage2D radiosity_projections;
layout(set = 0, binding = 3) uniform sampler2D radiosity_scales;
layout(set = 0, binding = 4, rg32ui) uniform readonly uimage2D radiosity_sent;
layout(set = 0, binding = 5, scalar) writeonly buffer radiosity_modes
{
    vec3 mode_table[];
};

shared vec3 part_of[RADIOSITY_PROJECT_LOCAL][RADIOSITY_MODES];

// The tuple of modes `t` of `count`, of this invocation's sources.
void add_sources(uvec4 region, uint tuples, uint t)
{
    const uint lane = gl_LocalInvocationID.x;
    vec3 sum[RADIOSITY_MODES];
    for (int m = 0; m < RADIOSITY_MODES; m++) sum[m] = vec3(0.0);
    const uint loads = region.w >> RADIOSITY_REGION_SHIFT;
    for (uint k = 0; k < loads; k++) {
        const uint source = region.y + RADIOSITY_PROJECT_LOCAL * k + lane;
        const uint node = texelFetch(radiosity_sources, radiosity_at(source), 0).x;
        const vec3 sent = radiosity_unpack(imageLoad(radiosity_sent, radiosity_at(node)).xy);
        const uvec4 words =
            imageLoad(radiosity_projections,
                      radiosity_at(region.x + (k * tuples + t) * RADIOSITY_PROJECT_LOCAL + lane));
        for (int j = 0; j < 4; j++) {
            sum[2 * j] += float(int(words[j] << 16) >> 16) * sent;
            sum[2 * j + 1] += float(int(words[j]) >> 16) * sent;
        }
    }
    for (int m = 0; m < RADIOSITY_MODES; m++) part_of[lane][m] = sum[m];
}

void main()
{
    const uvec4 region = region_table[push.first + gl_WorkGroupID.x];
    const uint tuples = region.w & ((1u << RADIOSITY_REGION_SHIFT) - 1u);
    for (uint t = 0; t < tuples; t++) {
        add_sources(region, tuples, t);
        barrier();
        const uint mode = gl_LocalInvocationID.x;
        vec3 sum = vec3(0.0);
        for (int i = 0; i < RADIOSITY_PROJECT_LOCAL; i++) sum += part_of[i][mode];
        const uint at = region.z + RADIOSITY_MODES * t + mode;
        sum *= texelFetch(radiosity_scales, radiosity_at(at), 0).x;
        mode_table[at] = sum;
        barrier();
    }
}
