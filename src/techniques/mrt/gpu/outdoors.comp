// The grid of outdoor probes: irradiance by normal of emitters, the sky and reflectors, in the
// format of frame/probes.glsl. Premultiplied by `open`, which is the component that the format
// leaves free.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/environment.glsl"
#include "frame/frame.glsl"
#include "frame/probes.glsl"
#define MRT_REFLECTOR_LIGHT_BINDING  4
#define MRT_REFLECTOR_SHARES_BINDING 5
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/reflectors.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 2, scalar) readonly buffer mrt_outdoor_probes
{
    mrt_gpu_outdoor_probe probe_table[];
};
layout(set = 0, binding = 3, rgba16f) writeonly uniform image3D outdoors;

void main()
{
    int i = int(gl_GlobalInvocationID.x);
    ivec3 at = probes_cell(level.outdoors, i);
    if (at.z >= level.outdoors.count_z) return;
    vec3 coefficients[9], environment[9];
    float sky[9]; // of radiance 1
    for (int k = 0; k < 9; k++) sky[k] = PI * probe_table[i].light.sky[k];
    environment_through(sky, environment);
    for (int k = 0; k < 9; k++) {
        coefficients[k] =
            probe_table[i].light.emitted[k] * (frame.radiance_scale * level.emitters) +
            environment[k];
    }
    add_reflected(probe_table[i].light.reflected, coefficients);
    for (int k = 0; k < 9; k++) coefficients[k] = clamp(coefficients[k], -HALF_MAX, HALF_MAX);
    for (int s = 0; s < FRAME_PROBE_SLABS; s++) {
        vec4 slab = probes_slab(coefficients, s);
        if (s == FRAME_PROBE_SLABS - 1) slab.w = probe_table[i].open;
        imageStore(outdoors, at + ivec3(0, 0, s * level.outdoors.slab), slab);
    }
}
