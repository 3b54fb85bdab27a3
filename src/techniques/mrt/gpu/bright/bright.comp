// The bright texels of each block: one workgroup per block. In a block with clutter there are none,
// since light between its walls is blocked.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING        2
#define MRT_TILES_BINDING         3
#define MRT_OPENINGS_BINDING      4
#define MRT_BRIGHT_COUNTS_BINDING 7
#define MRT_BRIGHT_TEXELS_BINDING 8
#define MRT_B_BRIGHT_BINDING      9
#include "techniques/mrt/gpu/bright/bright.glsl"
#include "techniques/mrt/gpu/operators.glsl"
#include "techniques/mrt/gpu/reduce.glsl"
#include "techniques/mrt/gpu/bright/wall_place.glsl"

layout(local_size_x = MRT_REDUCE_LOCAL) in;

layout(set = 0, binding = 5, scalar) readonly buffer mrt_direct
{
    vec3 direct_table[];
};
layout(set = 0, binding = 6) readonly buffer mrt_t_db
{
    uint t_db[]; // [row][k_b]
};

shared float sums[MRT_REDUCE_LOCAL];
shared uint counts[MRT_REDUCE_LOCAL];
shared vec4 listed[MRT_BRIGHT_TEXELS]; // radiosity above the mean, texel of the block

float brightness(vec3 radiosity)
{
    return dot(radiosity, vec3(1.0));
}

// All invocations call it together.
float mean_brightness(uint first, uint texels, uint lane)
{
    float sum = 0.0;
    for (uint i = lane; i < texels; i += MRT_REDUCE_LOCAL)
        sum += brightness(direct_table[first + i]);
    sums[lane] = sum;
    barrier();
    if (lane == 0u)
        for (uint i = 1u; i < MRT_REDUCE_LOCAL; i++) sums[0] += sums[i];
    barrier();
    return sums[0] / float(texels);
}

bool has_clutter(uint block)
{
    uint first = block_table[block].first_opening, count = block_table[block].openings;
    bool found = false;
    for (uint k = 0u; k < count; k++) found = found || opening_table[first + k].clutter >= 0;
    return found;
}

// All above the mean from twice the limit on; less of it below, so that light that changes makes no
// step.
vec3 excess(vec3 radiosity, float limit, float mean)
{
    float bright = max(brightness(radiosity), 1e-30);
    return radiosity * (clamp(bright / limit - 1.0, 0.0, 1.0) * (1.0 - mean / bright));
}

// Texel of the block, and the wall that has it.
mrt_gpu_bright_texel texel_of(uint block, uint texel, vec3 radiosity)
{
    int wall = int(texel / level.texels_of_tile), face = 0;
    for (int f = 0; f < 6; f++)
        if (block_table[block].tile[f] >= 0) {
            if (wall == 0) face = f;
            wall--;
        }
    mrt_wall at = wall_of(block, face);
    return mrt_gpu_bright_texel(place_of(at, texel % level.texels_of_tile), at.normal, radiosity);
}

// In the order of texels, whatever the order of invocations.
uint list_texels(uint block, float limit, float mean, uint lane)
{
    uint first = block_table[block].first_texel, texels = block_table[block].texels;
    uint each = (texels + MRT_REDUCE_LOCAL - 1u) / MRT_REDUCE_LOCAL;
    uint begin = lane * each, end = min(begin + each, texels), count = 0u;
    for (uint i = begin; i < end; i++)
        count += brightness(direct_table[first + i]) > limit ? 1u : 0u;
    counts[lane] = count;
    barrier();
    if (lane == 0u)
        for (uint i = 1u; i < MRT_REDUCE_LOCAL; i++) counts[i] += counts[i - 1u];
    barrier();
    uint at = counts[lane] - count, total = counts[MRT_REDUCE_LOCAL - 1u];
    for (uint i = begin; i < end; i++) {
        vec3 radiosity = direct_table[first + i];
        if (brightness(radiosity) <= limit || at >= MRT_BRIGHT_TEXELS) continue;
        vec3 above = excess(radiosity, limit, mean);
        listed[at] = vec4(above, uintBitsToFloat(i));
        bright_table[block * MRT_BRIGHT_TEXELS + at] = texel_of(block, i, above);
        at++;
    }
    barrier();
    return min(total, MRT_BRIGHT_TEXELS);
}

void project(uint block, uint count, uint lane)
{
    uint quad = lane % QUADS_B, stripe = lane / QUADS_B, stripes = MRT_REDUCE_LOCAL / QUADS_B;
    uint row = block_table[block].basis_row;
    vec4 sum[3] = { vec4(0.0), vec4(0.0), vec4(0.0) };
    if (stripe < stripes)
        for (uint i = stripe; i < count; i += stripes) {
            vec4 weights = MRT_QUAD(t_db, (row + floatBitsToUint(listed[i].w)) * QUADS_B + quad);
            for (int c = 0; c < 3; c++) sum[c] += weights * listed[i][c];
        }
    for (int c = 0; c < 3; c++) partial_sums[c][lane] = sum[c];
    barrier();
    if (lane < 3u * QUADS_B)
        b_bright_table[block * 3u * QUADS_B + lane] =
            sum_of_stripes(lane / QUADS_B, lane % QUADS_B, QUADS_B);
}

void main()
{
    uint block = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
    uint texels = block_table[block].texels;
    // At most MRT_BRIGHT_TEXELS are above the limit.
    float times = max(MRT_BRIGHT_TIMES, float(texels) / float(MRT_BRIGHT_TEXELS));
    float mean = mean_brightness(block_table[block].first_texel, texels, lane);
    uint count = list_texels(block, max(times * mean, 1e-30), mean, lane);
    if (has_clutter(block)) count = 0u;
    if (lane == 0u) bright_count_table[block] = count;
    project(block, count, lane);
}
