// Divides the faces of each block into parts, the faces that lie on one surface, for
// lighting/bounce.comp. The order of the list changes no result.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/lighting/part.glsl"
#include "techniques/vct/rays/jitter.glsl"
#include "techniques/vct/volume/volume_shared.h"

layout(local_size_x = VCT_BLOCK_LOCAL) in;

layout(constant_id = VCT_CONSTANT_BLOCK) const uint VCT_BLOCK = 2u; // texels along a block: 2 or 4

layout(set = 0, binding = 1, scalar) readonly buffer vct_texels
{
    uint texels[];
};
layout(set = 0, binding = 2, scalar) readonly buffer vct_texel_counts
{
    vct_texel_levels state;
};
layout(set = 0, binding = 3) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 4, rgba32ui) uniform writeonly uimage2D vct_parts;
layout(set = 0, binding = 5, r32ui) uniform writeonly uimage2D vct_part_of_face;
layout(set = 0, binding = 6, scalar) buffer vct_part_counts
{
    vct_part_count counts;
};
#define VCT_SLOTS(name)   vct_##name
#define VCT_SLOTS_BINDING 7
#include "techniques/vct/voxelize/slots.glsl"

#include "techniques/vct/voxelize/surface.glsl"

ivec3 block_texel; // first texel of the block
uint block_face;

const float ONE_SURFACE = 0.9; // least cosine between normals of one surface: 26 degrees
// Largest distance from the plane of the first face, in voxels: a surface further behind is another
// one, with its own light.
const float PLANE_DISTANCE = 1.0;

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
    vec3 first_normal;
    float outermost; // largest distance of a face along `first_normal`, from the block's corner
    bool covers;     // whether they cover any area
};

// Takes the first face without a part and all others with its normal and plane, on its side of
// partitions. False: none is left.
bool next_part(out vct_part part)
{
    part = vct_part(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), -1e6, false);
    vec3 first_position = vec3(0.0);
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
            part.first_normal = surface.normal;
            first_position = position;
            first_side = side_of(ivec3(voxel_of(row, bit)));
        } else if (dot(surface.normal, part.first_normal) < ONE_SURFACE ||
                   abs(dot(position - first_position, part.first_normal)) > PLANE_DISTANCE ||
                   side_of(ivec3(voxel_of(row, bit))) != first_side) {
            continue;
        }
        first = false;
        taken |= 1u << bit;
        part.normal += surface.weight * surface.normal;
        part.position += surface.weight * position;
        part.weight += surface.weight;
        part.covers = part.covers || surface.covers;
        if (surface.covers) part.outermost = max(part.outermost, dot(position, part.first_normal));
    }
}

void store_part(uint part)
{
    uint row = 0u, rest = rows_part[own(0u)];
    for (;;) {
        while (rest == 0u && ++row < ROWS) rest = rows_part[own(row)];
        if (rest == 0u) return;
        uint slot = slot_of(row, uint(findLSB(rest)));
        if (slot != VCT_NO_SLOT) imageStore(vct_part_of_face, vct_face_texel(slot), uvec4(part));
        rest &= rest - 1u;
    }
}

// Start of the part's rays, from the block's corner: the mean of its faces, moved out to the
// outermost one. A start behind a double-sided surface would see its back alone.
vec3 start_of(vct_part part)
{
    vec3 mean = part.position / max(part.weight, 1.0);
    float behind = part.outermost - dot(mean, part.first_normal);
    return mean + max(behind, 0.0) * part.first_normal;
}

uint enter(vct_part part, uint number)
{
    if (!part.covers) return VCT_NO_SLOT;
    uint place = atomicAdd(counts.count, 1u);
    atomicMax(counts.groups[0], place / VCT_BLOCK_LOCAL + 1u);
    atomicMax(counts.turn_groups[0], place / (VCT_BLOCK_LOCAL * VCT_PARTS_EACH) + 1u);
    vec3 position = vec3(2 * block_texel) + start_of(part);
    uint tile = vct_morton(uvec2(vct_morton(uvec2(block_texel.xy)), block_texel.z));
    uvec3 block = uvec3(block_texel) / VCT_BLOCK;
    vct_part_record record = vct_part_record(position, normalize(part.normal),
                                             64u * (number + 1u) + 8u * tile + block_face,
                                             block.x + 3u * block.z + 5u * block.y);
    imageStore(vct_parts, vct_face_texel(place), vct_pack_part(record));
    return place;
}

// A workgroup takes one face of its blocks.
void main()
{
    uint i = gl_WorkGroupID.x / VCT_FACES * VCT_BLOCK_LOCAL + gl_LocalInvocationID.x;
    uint level = VCT_BLOCK == 4u ? 2u : 1u;
    if (i >= state.count[level]) return;
    uint dim = uint(vct.volume_dim), half_dim = dim / 2u;
    uint first = dim * dim * dim + (level == 2u ? half_dim * half_dim * half_dim : 0u);
    block_texel = int(VCT_BLOCK) * vct_unpack_texel(texels[first + i]);
    block_face = gl_WorkGroupID.x % VCT_FACES;
    read_rows();
    vct_part part;
    for (uint number = 0u; next_part(part); number++) store_part(enter(part, number));
}
