// Adds the partial sums in one workgroup and computes the irradiance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/ambient/ambient_tree.glsl"

layout(local_size_x = AMBIENT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    ambient_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer ambient_partials
{
    vec3 partials[];
};
layout(set = 0, binding = 1, scalar) writeonly buffer ambient_result
{
    vec3 irradiance;
};

void main()
{
    uint me = gl_LocalInvocationIndex;
    vec3 flux = workgroup_sum(push.blocks > 0u && me < AMBIENT_GROUPS ? partials[me] : vec3(0.0));
    if (me == 0u) irradiance = push.strength * (push.uniform_irradiance + flux * push.per_path);
}
