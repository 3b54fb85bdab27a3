// Light from other voxels and the sky on each voxel, by cones: irradiance on both sides of its
// surface. With one bounce from emission and sky only, with more from all light that the voxels
// sent in the previous frame. Voxels of one block that lie on one surface share the irradiance at
// their centre: bounced light varies slowly.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/volume/volume_shared.h"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = VCT_BLOCK_LOCAL) in;

layout(constant_id = VCT_CONSTANT_BLOCK) const uint VCT_BLOCK = 2u; // texels along a block: 2 or 4

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler3D light;
layout(set = 0, binding = 4, scalar) readonly buffer vct_texels
{
    uint texels[];
};
layout(set = 0, binding = 5, scalar) readonly buffer vct_texel_counts
{
    vct_texel_levels state;
};
layout(set = 0, binding = 6) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 7, rgba32ui) uniform writeonly uimage2D vct_bounced;
layout(set = 0, binding = 8, scalar) readonly buffer vct_mask
{
    uint mask[];
};
layout(set = 0, binding = 9, scalar) readonly buffer vct_word_offsets
{
    uint before[];
};

#include "techniques/vct/lighting/basis.glsl"
#include "techniques/vct/voxelize/surface.glsl"
#include "techniques/vct/cones/trace.glsl"

#define VCT_SMALL_EMITTERS_BINDING 10
#include "techniques/vct/cones/small_emitters.glsl"

const uint EMITTER_SAMPLES = 4u; // of the points on a small emitter

vec3 small_emitters_at(vec3 at, vec3 normal)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < EMITTER_SAMPLES; i++) {
        vec3 to, found = vct_small_emitter_light(light, i * (VCT_EMITTER_POINTS / EMITTER_SAMPLES),
                                                 at, normal, vct.level, to);
        sum += found * dot(normal, to);
    }
    return sum * (float(VCT_EMITTER_POINTS) / float(EMITTER_SAMPLES));
}

vec3 irradiance(vec3 position, vec3 normal)
{
    mat3 world_from_local = vct_axes_about(normal);
    // With one grid both origins are equal, and the subtraction is exact.
    vec3 at = (position - (VCT_CLIPS > 1 ? clips.origin_m : vct.origin_m)) / set.texel_m;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < set.cone_count; i++) {
        vec4 met = vct_cone(light, at, normal, world_from_local * set.cones[i].xyz, set.offset,
                            set.width_per_m, set.last_mip, vct_start(vct.level, 0.0));
        sum += set.cones[i].w * (met.rgb * vct.light_scale + (1.0 - met.a) * frame.sky);
    }
    if (VCT_HAS_SMALL_EMITTERS) sum += small_emitters_at(at, normal);
    return min(sum, vec3(HALF_MAX));
}

const float ONE_SURFACE = 0.9; // least cosine between normals of one surface: 26 degrees

// Largest distance from the plane of the first voxel: a quarter of the block, in voxels.
float max_plane_distance()
{
    return 0.5 * float(VCT_BLOCK);
}

// The voxels of a block are stored in rows of texels along x, 8 bits per texel. Per row: all
// occupied bits, those without a part yet, those of the current part, and the slot of the first
// voxel. Each invocation has its own rows.
const uint ROWS = VCT_BLOCK * VCT_BLOCK, MAX_ROWS = 16u;
shared uint rows_occupied[MAX_ROWS * VCT_BLOCK_LOCAL], rows_left[MAX_ROWS * VCT_BLOCK_LOCAL],
    rows_part[MAX_ROWS * VCT_BLOCK_LOCAL], rows_first[MAX_ROWS * VCT_BLOCK_LOCAL];

uint own(uint row)
{
    return row * VCT_BLOCK_LOCAL + gl_LocalInvocationID.x;
}

void read_rows(ivec3 first_texel)
{
    for (uint row = 0u; row < ROWS; row++) {
        uint index = vct_texel_index(first_texel + ivec3(0, row % VCT_BLOCK, row / VCT_BLOCK));
        uint shift = 8u * (index & 3u), word = mask[index >> 2];
        uint bits = word >> shift & (VCT_BLOCK == 4u ? ~0u : 0xffffu);
        uint first = before[index >> 2] + uint(bitCount(word & ((1u << shift) - 1u)));
        // Voxels beyond the capacity do not exist.
        for (uint capacity = vct.capacity - min(first, vct.capacity);
             uint(bitCount(bits)) > capacity;)
            bits &= ~(1u << uint(findMSB(bits)));
        rows_occupied[own(row)] = rows_left[own(row)] = bits;
        rows_first[own(row)] = first;
    }
}

// Position of a voxel in the block, from its bit in a row.
vec3 position_of(uint row, uint bit)
{
    return vec3(uvec3(bit >> 3, row % VCT_BLOCK, row / VCT_BLOCK) * 2u +
                (uvec3(bit) >> uvec3(0u, 1u, 2u) & 1u));
}

uint slot_of(uint row, uint bit)
{
    return rows_first[own(row)] + uint(bitCount(rows_occupied[own(row)] & ((1u << bit) - 1u)));
}

// Voxels of one block that lie on one surface.
struct vct_part {
    vec3 normal;
    vec3 position; // voxels from the block's corner × weight
    float weight;
    bvec2 covers; // whether there is a front, a back
};

// Takes the first voxel without a part and all others with its normal and plane. False: none is
// left.
bool take_part(out vct_part part)
{
    part = vct_part(vec3(0.0), vec3(0.0), 0.0, bvec2(false));
    vec3 first_normal = vec3(0.0), first_position = vec3(0.0);
    bool first = true;
    uint row = 0u, rest = rows_left[own(0u)], taken = 0u;
    for (;;) {
        while (rest == 0u && row < ROWS) {
            rows_part[own(row)] = taken;
            rows_left[own(row)] &= ~taken;
            taken = 0u;
            row++;
            rest = row < ROWS ? rows_left[own(min(row, ROWS - 1u))] : 0u;
        }
        if (rest == 0u) return !first;
        uint bit = uint(findLSB(rest));
        rest &= rest - 1u;
        vct_surface surface =
            vct_unpack_surface(texelFetch(vct_surfaces, vct_voxel_texel(slot_of(row, bit)), 0));
        vec3 position = position_of(row, bit) + 0.5 + surface.position;
        if (first) {
            first_normal = surface.normal;
            first_position = position;
        } else if (dot(surface.normal, first_normal) < ONE_SURFACE ||
                   abs(dot(position - first_position, first_normal)) > max_plane_distance()) {
            continue;
        }
        first = false;
        taken |= 1u << bit;
        part.normal += surface.weight * surface.normal;
        part.position += surface.weight * position;
        part.weight += surface.weight;
        part.covers.x = part.covers.x || surface.covers.x;
        part.covers.y = part.covers.y || surface.covers.y;
    }
}

void store_part(vec3 front, vec3 back)
{
    uint row = 0u, rest = rows_part[own(0u)];
    uvec4 texel = uvec4(packHalf2x16(front.rg), packHalf2x16(vec2(front.b, back.r)),
                        packHalf2x16(back.gb), 0u);
    for (;;) {
        while (rest == 0u && ++row < ROWS) rest = rows_part[own(row)];
        if (rest == 0u) return;
        imageStore(vct_bounced, vct_bounced_texel(slot_of(row, uint(findLSB(rest)))), texel);
        rest &= rest - 1u;
    }
}

// Both sides in a loop, which ends early where no invocation of a group has a second side.
void gather(ivec3 corner, vct_part part, out vec3 front, out vec3 back)
{
    front = back = vec3(0.0);
    if (part.normal == vec3(0.0)) return;
    vec3 position = vct_world_from_voxels(vec3(corner) + part.position / part.weight);
    vec3 normal = normalize(part.normal);
    for (int side = part.covers.x ? 0 : 1; side < (part.covers.y ? 2 : 1); side++) {
        vec3 e = irradiance(position, side == 0 ? normal : -normal);
        if (side == 0)
            front = e;
        else
            back = e;
    }
}

void main()
{
    uint i = gl_GlobalInvocationID.x, level = VCT_BLOCK == 4u ? 2u : 1u;
    if (i >= state.count[level]) return;
    uint dim = uint(vct.volume_dim), half_dim = dim / 2u;
    uint first = dim * dim * dim + (level == 2u ? half_dim * half_dim * half_dim : 0u);
    ivec3 texel = int(VCT_BLOCK) * vct_unpack_texel(texels[first + i]);
    read_rows(texel);
    vct_part part;
    while (take_part(part)) {
        vec3 front, back;
        gather(2 * texel, part, front, back);
        store_part(front, back);
    }
}
