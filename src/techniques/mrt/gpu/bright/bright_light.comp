// The first bounce of bright texels, by form factors, in place of that of their b: added to the
// light of texels that is no b.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING        2
#define MRT_TILES_BINDING         3
#define MRT_TEXELS_BINDING        4
#define MRT_BRIGHT_COUNTS_BINDING 7
#define MRT_BRIGHT_TEXELS_BINDING 8
#define MRT_B_BRIGHT_BINDING      9
#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/octahedral.glsl"
#include "techniques/mrt/gpu/bright/bright.glsl"
#include "techniques/mrt/gpu/operators.glsl"
#include "techniques/mrt/gpu/bright/wall_place.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_VALUES) const uint VALUES = 1;

layout(set = 0, binding = 5) readonly buffer mrt_u_b
{
    uint u_b[]; // [row][k_b]
};
layout(set = 0, binding = 10) readonly buffer mrt_u_b_vector
{
    uint u_b_vector[]; // [row][4][k_b]
};
layout(set = 0, binding = 6, scalar) buffer mrt_area_light
{
    mrt_gpu_area_light area_light_table[];
};

shared vec4 coefficients[3 * MRT_MAX_QUADS];

vec3 of_modes(uint row)
{
    vec3 sum = vec3(0.0);
    for (uint q = 0u; q < QUADS_B; q++) {
        vec4 weights = MRT_QUAD(u_b, row * QUADS_B + q);
        for (uint c = 0u; c < 3u; c++) sum[c] += dot(weights, coefficients[c * QUADS_B + q]);
    }
    return sum;
}

vec3 of_vector_modes(uint row, uint value)
{
    vec3 sum = vec3(0.0);
    for (uint q = 0u; q < QUADS_B; q++) {
        vec4 weights = MRT_QUAD(u_b_vector, (row * 4u + value) * QUADS_B + q);
        for (uint c = 0u; c < 3u; c++) sum[c] += dot(weights, coefficients[c * QUADS_B + q]);
    }
    return sum;
}

// Irradiance of a disk of the texel's area (the form factor to its middle: A cos cos / (π d² + A)).
// vector: a column for each colour.
void add_texel(mrt_gpu_bright_texel from, vec3 position, vec3 normal, inout vec3 irradiance,
               inout mat3 vector)
{
    vec3 to = from.position - position;
    float distance2 = max(dot(to, to), 1e-12);
    vec3 direction = to * inversesqrt(distance2);
    float area = length(from.normal);
    float sent = max(0.0, -dot(from.normal, direction)) / (PI * distance2 + area);
    irradiance += from.radiosity * (sent * max(0.0, dot(normal, direction)));
    if (VALUES == 4u && dot(normal, direction) > 0.0)
        vector += outerProduct(direction, from.radiosity * sent);
}

void main()
{
    mrt_gpu_tile tile = tile_table[gl_WorkGroupID.y];
    uint lane = gl_LocalInvocationIndex, i = gl_GlobalInvocationID.x;
    uint count = bright_count_table[tile.block];
    if (lane < 3u * QUADS_B) coefficients[lane] = b_bright_table[tile.block * 3u * QUADS_B + lane];
    barrier();
    if (count == 0u || i >= level.texels_of_tile) return;
    mrt_wall wall = wall_of(tile.block, int(tile.response_row / level.texels_of_tile));
    vec3 position = place_of(wall, i), normal = normalize(wall.normal), irradiance = vec3(0.0);
    mat3 vector = mat3(0.0);
    for (uint k = 0u; k < count; k++)
        add_texel(bright_table[tile.block * MRT_BRIGHT_TEXELS + k], position, normal, irradiance,
                  vector);
    uint row = tile.basis_row + i, texel = tile.first_texel + i;
    area_light_table[texel].irradiance += irradiance - of_modes(row);
    if (VALUES == 1u) return;
    vec3 across = octahedral_decode(unpackSnorm2x16(texel_table[texel].across));
    float scale = SH_Y1 * MRT_VECTOR_OF_SLOPE;
    area_light_table[texel].along[0] += across * vector - scale * of_vector_modes(row, 3u);
    area_light_table[texel].along[1] +=
        cross(texel_table[texel].normal, across) * vector - scale * of_vector_modes(row, 1u);
}
