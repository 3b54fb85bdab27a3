#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

// The environment over lobes: environment_lobe.
#define ENVIRONMENT_MAP_BINDING 1
#include "frame/environment_map.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 2, scalar) readonly buffer lobes
{
    vec4 lobe[]; // direction of any length, sigma
};
layout(set = 0, binding = 3, scalar) writeonly buffer means
{
    vec3 mean[];
};
layout(push_constant, scalar) uniform push_block
{
    uint count;
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    mean[i] = environment_lobe(lobe[i].xyz, lobe[i].w);
}
