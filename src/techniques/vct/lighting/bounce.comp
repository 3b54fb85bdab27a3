// Light from other voxels and the sky on the faces of each voxel, by cones: irradiance. With one
// bounce from emission and sky only, with more from all light that the voxels sent in the previous
// frame. Faces of one block that lie on one surface share the irradiance at their centre: bounced
// light varies slowly.
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
#define VCT_SLOTS(name)   vct_##name
#define VCT_SLOTS_BINDING 8
#include "techniques/vct/voxelize/slots.glsl"

#include "techniques/vct/lighting/basis.glsl"
#include "techniques/vct/voxelize/surface.glsl"
#include "techniques/vct/cones/trace.glsl"
#if !VCT_SVO
#include "techniques/vct/rays/jitter.glsl"
#define VCT_RAY_VOXELS_CHANGE
#include "techniques/vct/rays/ray.glsl"
#endif

#define VCT_SMALL_EMITTERS_BINDING 10
#include "techniques/vct/cones/small_emitters.glsl"

ivec3 block_texel; // first texel of the block
uint block_face;

const float VCT_PI = 3.14159265;

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

uint part_number = 0u; // of all parts that the invocation has taken

vec3 irradiance(vec3 position, vec3 normal)
{
#if !VCT_SVO
    uint tile =
        vct_morton(uvec2(vct_morton(uvec2(block_texel.xy)), block_texel.z)) * 8u + block_face;
    part_number++;
#endif
    mat3 world_from_local = vct_axes_about(normal);
    // With one grid both origins are equal, and the subtraction is exact.
    vec3 at = (position - (VCT_CLIPS > 1 ? clips.origin_m : vct.origin_m)) / set.texel_m;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < set.cone_count; i++) {
        vec3 direction = world_from_local * set.cones[i].xyz;
        float weight = set.cones[i].w;
        vec4 met;
#if !VCT_SVO
        if (VCT_RAYS) {
            direction = world_from_local * vct_cosine_direction(vct_in_stratum(
                                               i, set.columns, set.cone_count / set.columns,
                                               vct_low_discrepancy(tile + 64u * part_number, i)));
            weight = VCT_PI / float(set.cone_count);
            met = vct_trace_ray(2.0 * at + VCT_RAY_LIFT * normal, normal, direction, 0.0);
        } else
#endif
            met = vct_cone(light, at, normal, direction, set.offset, set.width_per_m, set.last_mip,
                           vct_start(vct.level, 0.0));
        sum += weight * (met.rgb * vct.light_scale + (1.0 - met.a) * frame.sky);
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

// The voxels of a block that have the invocation's face are stored in rows of texels along x, 8
// bits per texel. Per row: those without a part yet, and those of the current part. Each invocation
// has its own rows.
const uint ROWS = VCT_BLOCK * VCT_BLOCK, MAX_ROWS = 16u;
shared uint rows_left[MAX_ROWS * VCT_BLOCK_LOCAL], rows_part[MAX_ROWS * VCT_BLOCK_LOCAL];

uint own(uint row)
{
    return row * VCT_BLOCK_LOCAL + gl_LocalInvocationID.x;
}

// Position of a voxel in the block, from its bit in a row.
uvec3 voxel_of(uint row, uint bit)
{
    return uvec3(bit >> 3, row % VCT_BLOCK, row / VCT_BLOCK) * 2u +
           (uvec3(bit) >> uvec3(0u, 1u, 2u) & 1u);
}

// VCT_NO_SLOT beyond the capacity.
uint slot_of(uint row, uint bit)
{
    return vct_slot(vct_face_index(2 * block_texel + ivec3(voxel_of(row, bit)), block_face));
}

// Bit 8 i of the four bytes of a word as bit i.
uint low_bits(uint word)
{
    return (word & 1u) | (word >> 7 & 2u) | (word >> 14 & 4u) | (word >> 21 & 8u);
}

// Per axis, the lowest voxel of the block with a face against it, and the highest one with a face
// along it. Between them is a solid: surfaces on its two sides are separate.
ivec3 solid_low = ivec3(1000), solid_high = ivec3(-1000);

// Adds four voxels from `low` on, 2 along x and y.
void find_solids(uint word, ivec3 low)
{
    for (int axis = 0; axis < 3; axis++) {
        uint along = low_bits(word >> (2 * axis)), against = low_bits(word >> (2 * axis + 1));
        // Voxels at the lower place along the axis, and at the upper one.
        uint lower = axis == 0 ? 5u : axis == 1 ? 3u : 15u, upper = axis == 2 ? 15u : ~lower;
        int upper_at = low[axis] + (axis == 2 ? 0 : 1);
        int first = (against & lower) != 0u ? low[axis] : upper_at,
            last = (along & upper) != 0u ? upper_at : low[axis];
        if (against != 0u) solid_low[axis] = min(solid_low[axis], first);
        if (along != 0u) solid_high[axis] = max(solid_high[axis], last);
    }
}

// Side of the block's solids along the face's plane, −1 or 1; 0 without any, or in the only voxel
// of a thin one. The outermost voxels of a thicker one belong to their sides.
ivec3 side_of(ivec3 voxel)
{
    ivec3 within = ivec3(lessThan(solid_low, solid_high));
    ivec3 side =
        ivec3(greaterThan(voxel + within, solid_high)) - ivec3(lessThan(voxel - within, solid_low));
    side = mix(side, ivec3(0), greaterThan(solid_low, solid_high));
    side[block_face / 2u] = 0;
    return side;
}

void read_rows()
{
    for (uint row = 0u; row < ROWS; row++) {
        uint word = 2u * vct_texel_index(block_texel + ivec3(0, row % VCT_BLOCK, row / VCT_BLOCK));
        uint bits = 0u;
        for (uint i = 0u; i < 2u * VCT_BLOCK; i++) {
            bits |= low_bits(vct_mask_words[word + i] >> block_face) << (4u * i);
            find_solids(vct_mask_words[word + i],
                        2 * ivec3(i >> 1, row % VCT_BLOCK, row / VCT_BLOCK) + ivec3(0, 0, i & 1u));
        }
        rows_left[own(row)] = bits;
    }
}

// Faces of one block that lie on one surface.
struct vct_part {
    vec3 normal;
    vec3 position; // voxels from the block's corner × weight
    float weight;
    bool covers; // whether they cover any area
};

// Takes the first face without a part and all others with its normal and plane, on its side of
// partitions. False: none is left.
bool take_part(out vct_part part)
{
    part = vct_part(vec3(0.0), vec3(0.0), 0.0, false);
    vec3 first_normal = vec3(0.0), first_position = vec3(0.0);
    ivec3 first_side = ivec3(0);
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
        uint bit = uint(findLSB(rest)), slot = slot_of(row, bit);
        rest &= rest - 1u;
        if (slot == VCT_NO_SLOT) {
            taken |= 1u << bit;
            continue;
        }
        vct_surface surface =
            vct_unpack_surface(texelFetch(vct_surfaces, vct_surface_texel(slot), 0));
        vec3 position = vec3(voxel_of(row, bit)) + 0.5 + surface.position;
        if (first) {
            first_normal = surface.normal;
            first_position = position;
            first_side = side_of(ivec3(voxel_of(row, bit)));
        } else if (dot(surface.normal, first_normal) < ONE_SURFACE ||
                   abs(dot(position - first_position, first_normal)) > max_plane_distance() ||
                   side_of(ivec3(voxel_of(row, bit))) != first_side) {
            continue;
        }
        first = false;
        taken |= 1u << bit;
        part.normal += surface.weight * surface.normal;
        part.position += surface.weight * position;
        part.weight += surface.weight;
        part.covers = part.covers || surface.covers;
    }
}

void store_part(vec3 irradiance)
{
    uint row = 0u, rest = rows_part[own(0u)];
    uvec4 texel = uvec4(packHalf2x16(irradiance.rg), packHalf2x16(vec2(irradiance.b, 0.0)), 0u, 0u);
    for (;;) {
        while (rest == 0u && ++row < ROWS) rest = rows_part[own(row)];
        if (rest == 0u) return;
        uint slot = slot_of(row, uint(findLSB(rest)));
        if (slot != VCT_NO_SLOT) imageStore(vct_bounced, vct_face_texel(slot), texel);
        rest &= rest - 1u;
    }
}

vec3 irradiance_on(vct_part part)
{
    if (!part.covers) return vec3(0.0);
    vec3 position =
        vct_world_from_voxels(vec3(2 * block_texel) + part.position / max(part.weight, 1.0));
    return irradiance(position, normalize(part.normal));
}

// A workgroup gathers for one face of its blocks.
void main()
{
    if (gl_WorkGroupID.x / VCT_FACES % set.rounds != set.round) return;
    uint i = gl_WorkGroupID.x / VCT_FACES * VCT_BLOCK_LOCAL + gl_LocalInvocationID.x;
    uint level = VCT_BLOCK == 4u ? 2u : 1u;
    if (i >= state.count[level]) return;
    uint dim = uint(vct.volume_dim), half_dim = dim / 2u;
    uint first = dim * dim * dim + (level == 2u ? half_dim * half_dim * half_dim : 0u);
    block_texel = int(VCT_BLOCK) * vct_unpack_texel(texels[first + i]);
    block_face = gl_WorkGroupID.x % VCT_FACES;
    read_rows();
    vct_part part;
    while (take_part(part)) store_part(irradiance_on(part));
}
