// Light of probes: the radiance that arrives, T L, and the probe volume of irradiance
// (frame/probes.glsl and common/probes/lookup.glsl).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/probes.glsl"
#include "techniques/prt/prt_transfer.glsl"
#include "techniques/prt/probes/probes_shared.h"

layout(local_size_x = PRT_PROBES_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    prt_probes_push push;
};
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D probe_table;
layout(set = 0, binding = 3, rgba16f) uniform writeonly image3D volume;
layout(set = 0, binding = 4, rgba16f) uniform writeonly image2D probe_radiance; // [row][probe]

vec4 probe_part(uint probe, uint part)
{
    return imageLoad(probe_table, light_map_at(part * push.probes + probe));
}

vec3 radiance_of(uint probe, uint row)
{
    vec3 radiance = prt_row_irradiance(row * push.probes + probe, push.rows * push.probes) +
                    push.emitters * probe_part(probe, PRT_PROBE_LIGHT + row).rgb;
    return clamp(radiance, -HALF_MAX, HALF_MAX);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.probes) return;
    vec3 irradiance[9];
    for (uint row = 0u; row < push.rows; row++) {
        vec3 radiance = radiance_of(i, row);
        imageStore(probe_radiance, light_map_at(row * push.probes + i), vec4(radiance, 0.0));
        if (row < 9u) irradiance[row] = sh9_cosine_weight(int(row)) * radiance;
    }
    for (int c = 0; c < 9; c++) irradiance[c] = clamp(irradiance[c], -HALF_MAX, HALF_MAX);
    ivec3 at = probes_cell(push.grid, int(i));
    for (int s = 0; s < FRAME_PROBE_SLABS; s++)
        imageStore(volume, at + ivec3(0, 0, s * push.grid.slab), probes_slab(irradiance, s));
    imageStore(volume, at + ivec3(0, 0, FRAME_PROBE_SLABS * push.grid.slab),
               probe_part(i, PRT_PROBE_OFFSET));
}
