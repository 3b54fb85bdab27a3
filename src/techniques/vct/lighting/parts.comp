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
#include "techniques/vct/rays/plane.glsl"
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

#include "techniques/vct/voxelize/line_places.glsl"
#include "techniques/vct/voxelize/surface.glsl"

ivec3 block_texel; // first texel of the block
uint block_face;

const float ONE_SURFACE = 0.9; // least cosine between normals of one surface: 26 degrees
// Largest distance from the plane of the first face, in voxels: a surface further behind is another
// one, with its own light.
const float PLANE_DISTANCE = 1.0;
const float WALL_IN_FRONT = 0.01; // least height of a wall's mean above a surface, in voxels

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

// Walls of a voxel that stand on a face's surface, by the two axes across the face: the heights of
// those along an axis and of those against it, from the voxel's centre. ±NO_WALL: none.
struct walls {
    vec2 along, against;
};

const float NO_WALL = 2.0; // voxels

// A wall in front of the surface's plane stands on it; one behind, such as the side of a box that
// the surface tops, does not.
void add_walls(inout walls w, ivec3 voxel, vec3 from, vec3 normal)
{
    uint others = vct_faces(vct_index(voxel)) & 63u & ~(3u << (block_face & ~1u));
    for (; others != 0u; others &= others - 1u) {
        uint face = uint(findLSB(others)), slot = vct_slot(vct_face_index(voxel, face));
        if (slot == VCT_NO_SLOT) continue;
        vct_surface wall = vct_unpack_surface(texelFetch(vct_surfaces, vct_surface_texel(slot), 0));
        if (!wall.covers || dot(wall.position - from, normal) < WALL_IN_FRONT) continue;
        uint across = (face / 2u + 2u - block_face / 2u) % 3u; // 0 or 1: vct_across
        if ((face & 1u) == 0u)
            w.along[across] = wall.position[face / 2u];
        else
            w.against[across] = wall.position[face / 2u];
    }
}

// Those of the voxel in front, then those of the face's own.
walls walls_on(ivec3 voxel, vct_surface surface)
{
    walls w = walls(vec2(-NO_WALL), vec2(NO_WALL));
    ivec3 in_front = voxel;
    in_front[block_face / 2u] += (block_face & 1u) == 0u ? 1 : -1;
    if (vct_inside(in_front))
        add_walls(w, in_front, vec3(-NO_WALL) * surface.normal, surface.normal);
    add_walls(w, voxel, surface.position, surface.normal);
    return w;
}

// Quadrant, 0 to 3, of a place on a surface in front of its walls; 4 below a wall. A wall that is
// thinner than the voxel has surface on both sides.
uint quadrant_of(vec2 at, walls w)
{
    uvec2 after = uvec2(greaterThan(at, w.along)), before = uvec2(lessThan(at, w.against));
    uvec2 thin = uvec2(greaterThanEqual(w.along, w.against));
    bool open =
        all(notEqual(mix(after & before, after | before, equal(thin, uvec2(1u))), uvec2(0u)));
    uvec2 lower = thin & before;
    return open ? lower.x + 2u * lower.y : 4u;
}

// Position of a face's surfaces in front of the walls that stand on it, from the voxel's centre.
// The mean of all may be below a wall, and rays from there would see what is outside. Where a wall
// has surface on both sides, the larger part counts. False: all is below walls.
bool position_in_front(ivec3 voxel, vct_surface surface, out vec3 position)
{
    position = surface.position;
    walls w = walls_on(voxel, surface);
    if (w.along == vec2(-NO_WALL) && w.against == vec2(NO_WALL)) return true;
    vec3 sums[5] = vec3[5](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < VCT_LINES; i++) {
        if ((surface.lines >> i & 1u) == 0u) continue;
        vec2 at = (vec2(vct_line_place(i)) + 0.5) / float(VCT_LINES) - 0.5;
        sums[quadrant_of(at, w)] += vec3(at, 1.0);
    }
    vec3 most = sums[0];
    for (uint i = 1u; i < 4u; i++) most = sums[i].z > most.z ? sums[i] : most;
    if (most.z == 0.0) return false;
    uint axis = block_face / 2u;
    vec2 moved = most.xy / most.z - vct_across(position, block_face);
    position[(axis + 1u) % 3u] += moved.x;
    position[(axis + 2u) % 3u] += moved.y;
    position[axis] -= dot(vct_across(surface.normal, block_face), moved) / surface.normal[axis];
    return true;
}

// Faces of one block that lie on one surface.
struct vct_part {
    vec3 normal;
    vec3 position; // of visible faces, voxels from the block's corner × weight
    float weight;  // of visible faces; 0: no light reaches the part
    vec3 first_normal;
    float outermost; // largest distance of a visible face along `first_normal`, from the corner
};

// Takes the first face without a part and all others with its normal and plane, on its side of
// partitions. False: none is left.
bool next_part(out vct_part part)
{
    part = vct_part(vec3(0.0), vec3(0.0), 0.0, vec3(0.0), -1e6);
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
        ivec3 voxel = ivec3(voxel_of(row, bit));
        vec3 position = surface.position;
        bool visible =
            surface.covers && position_in_front(2 * block_texel + voxel, surface, position);
        position += vec3(voxel) + 0.5;
        if (first) {
            part.first_normal = surface.normal;
            first_position = position;
            first_side = side_of(voxel);
        } else if (dot(surface.normal, part.first_normal) < ONE_SURFACE ||
                   abs(dot(position - first_position, part.first_normal)) > PLANE_DISTANCE ||
                   side_of(voxel) != first_side) {
            continue;
        }
        first = false;
        taken |= 1u << bit;
        part.normal += surface.weight * surface.normal;
        if (!visible) continue;
        part.position += surface.weight * position;
        part.weight += surface.weight;
        part.outermost = max(part.outermost, dot(position, part.first_normal));
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
    vec3 mean = part.position / part.weight;
    float behind = part.outermost - dot(mean, part.first_normal);
    return mean + max(behind, 0.0) * part.first_normal;
}

uint enter(vct_part part, uint number)
{
    if (part.weight == 0.0) return VCT_NO_SLOT;
    uint place = atomicAdd(counts.count, 1u);
    atomicMax(counts.groups[0], place / VCT_BLOCK_LOCAL + 1u);
    atomicMax(counts.turn_groups[0], place / (VCT_BLOCK_LOCAL * VCT_PARTS_EACH) + 1u);
    vec3 position = vec3(2 * block_texel) + start_of(part);
    // From the corner of the scene's grid: the same rays after a step of a level.
    uvec3 texel = uvec3(block_texel + ivec3(0.5 - 0.5 * vct.scene_low)), block = texel / VCT_BLOCK;
    uint tile = vct_morton(uvec2(vct_morton(texel.xy), texel.z));
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
