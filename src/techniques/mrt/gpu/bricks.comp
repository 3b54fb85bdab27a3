// Bricks of probes: irradiance by normal in the world frame, from that of indirect light in the
// cells of the blocks and that of emitters, the sky and reflectors (Loos 2015, section 3.5.5). The
// border of a brick has probes of the blocks beyond its openings.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/environment.glsl"
#include "frame/frame.glsl"
#include "frame/probes.glsl"
#define MRT_REFLECTOR_LIGHT_BINDING  7
#define MRT_REFLECTOR_SHARES_BINDING 8
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 2) readonly buffer mrt_brick_sources
{
    uint source_table[]; // [block][texel]: a probe of the level
};
layout(set = 0, binding = 3, scalar) readonly buffer mrt_probe_light
{
    vec3 light_table[]; // [probe][9], in the frame of the cell
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_probe_area_light
{
    mrt_gpu_probe area_light_table[];
};
layout(set = 0, binding = 5, scalar) readonly buffer mrt_probe_turns
{
    float turn_table[]; // [block][9][9]: SH from cell to world
};
layout(set = 0, binding = 6, rgba16f) writeonly uniform image3D bricks;

vec3 rotated(uint probe, uint block, int i)
{
    int first = i == 0 ? 0 : i < 4 ? 1 : 4, end = i == 0 ? 1 : i < 4 ? 4 : 9;
    vec3 sum = vec3(0.0);
    for (int k = first; k < end; k++)
        sum +=
            turn_table[(block * 9u + uint(i)) * 9u + uint(k)] * light_table[probe * 9u + uint(k)];
    return sum;
}

void main()
{
    uint i = gl_GlobalInvocationID.x, block = gl_WorkGroupID.y, p = level.probes, edge = p + 2u;
    uint texels = edge * edge * edge;
    if (i >= texels) return;
    uint probe = source_table[block * texels + i], source = probe / (p * p * p);
    vec3 coefficients[9], environment[9];
    float sky[9]; // of radiance 1
    for (int k = 0; k < 9; k++) sky[k] = PI * area_light_table[probe].sky[k];
    environment_through(sky, environment);
    for (int k = 0; k < 9; k++) {
        vec3 area_light =
            area_light_table[probe].emitted[k] * (frame.radiance_scale * level.emitters) +
            environment[k];
        coefficients[k] = rotated(probe, source, k) + area_light;
    }
    add_reflected(area_light_table[probe].reflected, coefficients);
    for (int k = 0; k < 9; k++) coefficients[k] = clamp(coefficients[k], -HALF_MAX, HALF_MAX);
    ivec3 at = ivec3(block % level.brick_columns, block / level.brick_columns, 0) * int(edge) +
               ivec3(i % edge, i / edge % edge, i / (edge * edge));
    for (int s = 0; s < FRAME_PROBE_SLABS; s++)
        imageStore(bricks, at + ivec3(0, 0, s * int(edge)), probes_slab(coefficients, s));
}
