// Runs ggx_albedo.glsl at pairs of n·v and roughness; test_twins.c compares it with C.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define GGX_ALBEDO_BINDING 0
#include "core/ggx_albedo.glsl"

layout(local_size_x = 64) in;

layout(scalar, binding = 1) readonly buffer Places
{
    vec2 places[]; // n·v, roughness
};
layout(scalar, binding = 2) writeonly buffer Albedos
{
    vec4 albedos[]; // A and B there, and averaged over the hemisphere
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= places.length()) return;
    albedos[i] = vec4(ggx_albedo_at(places[i].x, places[i].y), ggx_albedo_mean(places[i].y));
}
