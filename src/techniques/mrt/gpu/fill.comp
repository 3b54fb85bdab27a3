// Texels of the light map, from those of the level: inside each tile a copy, in its border a
// weighted sum that continues walls through openings (Loos 2015, section 4.6).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TILES_BINDING 2
#include "core/half.glsl"
#include "core/sh.glsl"
#include "techniques/mrt/gpu/level.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_VALUES) const uint VALUES = 1;

layout(set = 0, binding = 3, scalar) readonly buffer mrt_borders
{
    mrt_gpu_border border_table[];
};
layout(set = 0, binding = 4, scalar) readonly buffer mrt_irradiance
{
    vec3 irradiance_table[]; // [texel][value]
};
layout(set = 0, binding = 6, scalar) readonly buffer mrt_area_light
{
    mrt_gpu_area_light area_light_table[]; // [texel]
};
// VALUES 1: one layer of RGB. VALUES 4: a layer for each of red, green, blue, with four values.
layout(set = 0, binding = 5, rgba16f) writeonly uniform image2DArray light_map;

void store(ivec2 at, vec3 values[4])
{
    if (VALUES == 1u) {
        imageStore(light_map, ivec3(at, 0), vec4(clamp(values[0], -HALF_MAX, HALF_MAX), 1.0));
        return;
    }
    for (int c = 0; c < 3; c++) {
        vec4 texel = vec4(values[0][c], values[1][c], values[2][c], values[3][c]);
        imageStore(light_map, ivec3(at, c), clamp(texel, -HALF_MAX, HALF_MAX));
    }
}

// By normal: the slopes of the fit that vector_of_fit (lobe.glsl) takes for its vector irradiance.
// Along the wall's normal that of uniform light, half of its irradiance. Its constant is that of
// the other layer.
void add_area_light(mrt_gpu_area_light light, float weight, inout vec3 sum[4])
{
    if (VALUES == 1u) {
        sum[0] += weight * light.irradiance;
    } else {
        sum[1] += weight / (MRT_VECTOR_OF_SLOPE * SH_Y1) * light.along[1];
        sum[2] += weight / (2.0 * SH_Y1) * light.irradiance;
        sum[3] += weight / (MRT_VECTOR_OF_SLOPE * SH_Y1) * light.along[0];
    }
}

void add(uint texel, float weight, inout vec3 sum[4])
{
    vec3 passed = weight * (1.0 - area_light_table[texel].hidden);
    for (uint v = 0u; v < VALUES; v++) sum[v] += passed * irradiance_table[texel * VALUES + v];
    add_area_light(area_light_table[texel], weight, sum);
}

void main()
{
    uint i = gl_GlobalInvocationID.x, width = level.map_width;
    vec3 sum[4] = { vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0) };
    if (i < level.texels) {
        mrt_gpu_tile tile = tile_table[i / level.texels_of_tile];
        int local = int(i % level.texels_of_tile), n = int(level.resolution);
        add(i, 1.0, sum);
        store(ivec2(tile.x + local % n, tile.y + local / n), sum);
    } else if (i < level.texels + level.borders) {
        uint border = i - level.texels;
        for (uint k = 0u; k < border_table[border].count; k++)
            add(border_table[border].source[k], border_table[border].weight[k], sum);
        uint at = border_table[border].texel;
        store(ivec2(at % width, at / width), sum);
    }
}
