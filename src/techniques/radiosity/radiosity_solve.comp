// One step of the Chebyshev semi-iterative method (Golub & Van Loan 2013, section 11.2.8) for
// B = B0 + ρ F B over the groups: B′ = ω (B0 + ρ F B − B_before) + B_before. ω = 1 is a bounce;
// ω = 0 stands for the last step, which leaves F B, the irradiance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_row.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_solve_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_groups
{
    radiosity_gpu_group group_table[];
};
// [entry][group]
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_group_factors
{
    uint factor_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_group_sent
{
    vec3 sent_table[]; // B0
};
layout(set = 0, binding = 3, scalar) readonly buffer radiosity_last
{
    vec3 last_table[]; // B
};
layout(set = 0, binding = 4, scalar) buffer radiosity_next
{
    vec3 next_table[]; // B_before, then B′
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.groups) return;
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < push.entries; k++) {
        uint word = factor_table[k * push.groups + i];
        if (radiosity_has_ended(word)) break;
        sum += radiosity_form_factor(word) * last_table[radiosity_source(word)];
    }
    if (push.over == 0.0) {
        next_table[i] = sum;
        return;
    }
    vec3 bounced = sent_table[i] + group_table[i].reflectance * sum;
    vec3 before = push.over == 1.0 ? vec3(0.0) : next_table[i];
    next_table[i] = push.over * (bounced - before) + before;
}
