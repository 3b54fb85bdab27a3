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
    vec3 irradiance_table[]; // [texel]
};
layout(set = 0, binding = 7, scalar) readonly buffer mrt_vector
{
    vec3 vector_table[]; // [texel][4]
};
layout(set = 0, binding = 6, scalar) readonly buffer mrt_area_light
{
    mrt_gpu_area_light area_light_table[]; // [texel]
};
layout(set = 0, binding = 8, scalar) readonly buffer mrt_shown
{
    uint shown_table[]; // [texel]: that whose area light the wall has there
};
// VALUES 1: one layer of RGB. VALUES 4: a layer for each of red, green and blue, as
// light_map_lookup reads them.
layout(set = 0, binding = 5, rgba16f) writeonly uniform image2DArray light_map;

// Light of a texel, in the frame of struct mrt_point. Irradiance by normal is E + s·(n − z):
// `twice` is 2 s.
struct texel_light {
    vec3 irradiance;
    mat3 twice; // a column for each axis
};

void store(ivec2 at, texel_light light)
{
    if (VALUES == 1u) {
        vec3 irradiance = clamp(light.irradiance, -HALF_MAX, HALF_MAX);
        imageStore(light_map, ivec3(at, 0), vec4(irradiance, 1.0));
        return;
    }
    for (int c = 0; c < 3; c++) {
        vec3 twice = vec3(light.twice[0][c], light.twice[1][c], light.twice[2][c]);
        vec4 texel = vec4(2.0 * light.irradiance[c] - twice.z, twice);
        imageStore(light_map, ivec3(at, c), clamp(texel, -HALF_MAX, HALF_MAX));
    }
}

// Along the wall's normal the vector irradiance of area light is that of uniform light.
void add_vector(uint texel, mrt_gpu_area_light area, float weight, vec3 passed,
                inout texel_light sum)
{
    passed *= 2.0 * SH_Y1;
    sum.twice[0] +=
        passed * vector_table[4u * texel + 3u] + weight * 2.0 / MRT_VECTOR_OF_SLOPE * area.along[0];
    sum.twice[1] +=
        passed * vector_table[4u * texel + 1u] + weight * 2.0 / MRT_VECTOR_OF_SLOPE * area.along[1];
    sum.twice[2] += passed * vector_table[4u * texel + 2u] + weight * area.irradiance;
}

void add(uint texel, float weight, inout texel_light sum)
{
    mrt_gpu_area_light area = area_light_table[shown_table[texel]];
    vec3 passed = weight * (1.0 - area.hidden);
    sum.irradiance += passed * irradiance_table[texel] + weight * area.irradiance;
    if (VALUES == 4u) add_vector(texel, area, weight, passed, sum);
}

void main()
{
    uint i = gl_GlobalInvocationID.x, width = level.map_width;
    texel_light sum = texel_light(vec3(0.0), mat3(0.0));
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
