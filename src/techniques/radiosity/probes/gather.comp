// The probe volume (frame/probes.glsl and common/probes/lookup.glsl): irradiance from the clusters,
// the sky and emissive surfaces, bands 0 to 2. Cells without a probe outside of geometry have the
// tables of another one.
//
// A row's entry has a share w of the sphere and the mean m of its directions. Its light w B/π · 4π
// has Y(m) in band 1. In band 2 it is a spherical cap, exact for a disk: caps of a half angle α
// have |m| = (1 + cos α)/2 and the share cos α (1 + cos α)/2 = |m| (2|m| - 1) of the harmonics of
// their axis, a half space none. Entries with less than that of |m| are no caps, but lie all
// around.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/sh.glsl"
#include "frame/environment.glsl"
#include "frame/frame.glsl"
#include "frame/probes.glsl"
#include "techniques/radiosity/radiosity_pack.glsl"
#include "techniques/radiosity/probes/probes_shared.h"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_probe_gather_push push;
};
layout(set = 0, binding = 1, scalar) readonly buffer probe_table
{
    radiosity_gpu_probe probes[];
};
// [entry][probe]: node; share of the sphere and x, y and z of the mean direction (halves).
layout(set = 0, binding = 2, scalar) readonly buffer probe_factors
{
    uvec3 factor_table[];
};
layout(set = 0, binding = 3) uniform usampler2D radiosity_sent;
layout(set = 0, binding = 5, scalar) readonly buffer emission_weights
{
    vec4 weight_table[]; // [column] by colour, cd/m²
};
layout(set = 0, binding = 6, scalar) readonly buffer probe_emission
{
    radiosity_gpu_probe_emission emission_table[]; // [column][probe]
};
layout(set = 0, binding = 4, rgba16f) uniform writeonly image3D volume;

vec3 coefficients[9];

void add_entry(uvec3 word)
{
    vec2 first = unpackHalf2x16(word.y), second = unpackHalf2x16(word.z);
    vec3 light =
        4.0 * first.x * radiosity_unpack(texelFetch(radiosity_sent, light_map_at(word.x), 0).xy);
    float x = first.y, y = second.x, z = second.y, r = length(vec3(x, y, z));
    float cap = r > 0.5 ? 2.0 - 1.0 / r : 0.0; // of x² + y² + z² = r²
    coefficients[0] += SH_Y0 * light;
    coefficients[1] += SH_Y1 * y * light;
    coefficients[2] += SH_Y1 * z * light;
    coefficients[3] += SH_Y1 * x * light;
    coefficients[4] += cap * SH_Y2_XY * x * y * light;
    coefficients[5] += cap * SH_Y2_XY * y * z * light;
    coefficients[6] += cap * SH_Y2_ZZ * (3.0 * z * z - r * r) * light;
    coefficients[7] += cap * SH_Y2_XY * x * z * light;
    coefficients[8] += cap * SH_Y2_XX_YY * (x * x - y * y) * light;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.probes) return;
    for (int c = 0; c < 9; c++) coefficients[c] = vec3(0.0);
    for (uint k = 0; k < push.entries; k++) {
        uvec3 word = factor_table[k * push.probes + i];
        if ((word.y & 0xffffu) == 0u) break; // rows end with zeros
        add_entry(word);
    }
    for (int c = 0; c < 9; c++) coefficients[c] *= sh9_cosine_weight(c);
    vec3 environment[9];
    environment_through(probes[i].sky, environment);
    for (uint k = 0u; k < push.columns; k++) {
        vec3 weight = frame.radiance_scale * weight_table[k].rgb;
        for (int c = 0; c < 9; c++)
            coefficients[c] += weight * emission_table[k * push.probes + i].sh[c];
    }
    for (int c = 0; c < 9; c++) {
        coefficients[c] += environment[c];
        coefficients[c] = clamp(coefficients[c], -HALF_MAX, HALF_MAX);
    }
    ivec3 at = probes_cell(push.grid, int(i));
    for (int s = 0; s < FRAME_PROBE_SLABS; s++)
        imageStore(volume, at + ivec3(0, 0, s * push.grid.slab), probes_slab(coefficients, s));
    imageStore(volume, at + ivec3(0, 0, FRAME_PROBE_SLABS * push.grid.slab), probes[i].place);
}
