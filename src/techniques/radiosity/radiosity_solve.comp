// One step of the Chebyshev semi-iterative method (Golub & Van Loan 2013, section 11.2.8) for
// B = B0 + ρ F B over the clusters: B′ = ω (B0 + ρ F B − B_before) + B_before. ω = 1 is a bounce.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/radiosity/radiosity_row.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_solve_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_clusters
{
    radiosity_gpu_cluster cluster_table[];
};
// [entry][cluster of the block]
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_cluster_factors
{
    uint factor_table[];
};
layout(set = 0, binding = 2, scalar) readonly buffer radiosity_sent
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
    uint row = gl_GlobalInvocationID.x;
    if (row >= push.count) return;
    vec3 sum = vec3(0.0);
    for (uint k = 0; k < push.entries; k++) {
        uint word = factor_table[k * push.count + row];
        if (radiosity_has_ended(word)) break;
        sum += radiosity_form_factor(word) * last_table[radiosity_source(word)];
    }
    uint i = push.first + row;
    vec3 bounced = sent_table[i] + cluster_table[i].reflectance * sum;
    vec3 before = push.over == 1.0 ? vec3(0.0) : next_table[i];
    next_table[i] = push.over * (bounced - before) + before;
}
