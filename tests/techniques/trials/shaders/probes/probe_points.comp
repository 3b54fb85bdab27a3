// Irradiance of a published probe volume at points of surfaces; of points without a normal its mean
// over all normals.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#if defined SEEN || defined PUBLISHED
#include "techniques/common/probes/lookup.glsl"
#endif

layout(local_size_x = 64) in;

layout(set = 0, binding = 0) uniform sampler3D volume;
layout(set = 0, binding = 1, scalar) buffer points
{
    vec3 point_table[]; // position, normal of each point; irradiance takes the position's place
};
#if defined SEEN || defined PUBLISHED
layout(set = 0, binding = 2) uniform sampler2D probe_depths;
#endif

layout(push_constant, scalar) uniform push_block
{
    frame_probes grid;
    uint count;
    int visibility;
};

#ifdef SEEN
vec3 on_surface(vec3 position, vec3 normal)
{
    return probes_visible_irradiance(volume, probe_depths, grid, position, normal, normal);
}

vec3 in_space(vec3 position)
{
    vec3 c[9];
    probes_visible_coefficients(volume, probe_depths, grid, position, c);
    return SH_Y0 * c[0];
}
#else
vec3 on_surface(vec3 position, vec3 normal)
{
#ifdef PUBLISHED
    return probes_published_irradiance(volume, probe_depths, grid, visibility, position, normal);
#else
    return probes_irradiance(volume, grid, position, normal);
#endif
}

// Bands 1 and 2 cancel over the axes.
vec3 in_space(vec3 position)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 6; i++) {
        vec3 normal = vec3(0.0);
        normal[i / 2] = i % 2 == 0 ? -1.0 : 1.0;
        sum += on_surface(position, normal) / 6.0;
    }
    return sum;
}
#endif

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 position = point_table[2 * i], normal = point_table[2 * i + 1];
    point_table[2 * i] = normal == vec3(0.0) ? in_space(position) : on_surface(position, normal);
}
