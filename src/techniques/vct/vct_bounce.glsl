// Light that other voxels and the sky bring to each voxel, by cones: irradiance on both sides of its sheet. What
// surfaces that glow bring on their straight way, and with more bounces all that the voxels sent out in the last
// frame. Voxels of one block that are parts of one sheet get what is brought to their middle.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"

layout(local_size_x = VCT_LOCAL) in;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler3D light;
layout(set = 0, binding = 4, scalar) readonly buffer vct_texels { uint texels[]; };
layout(set = 0, binding = 5, scalar) readonly buffer vct_texel_state { vct_texel_levels state; };
layout(set = 0, binding = 6) uniform usampler2D vct_surfaces;
layout(set = 0, binding = 7, scalar) writeonly buffer vct_brought { uint brought[]; };
layout(set = 0, binding = 8, scalar) readonly buffer vct_mask { uint mask[]; };
layout(set = 0, binding = 9, scalar) readonly buffer vct_before { uint before[]; };

#include "techniques/vct/vct_axes.glsl"
#include "techniques/vct/vct_surface.glsl"
#include "techniques/vct/vct_trace.glsl"

#define VCT_LAMPS_BINDING 10
#include "techniques/vct/vct_lamps.glsl"

const uint LAMP_SAMPLES = 4u; // of the points that a lamp has

vec3 lamps_at(vec3 at, vec3 normal)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < LAMP_SAMPLES; i++) {
        vec3 to, found = vct_lamp_light(light, i * (VCT_LAMP_POINTS / LAMP_SAMPLES), at, normal, vct.level, to);
        sum += found * dot(normal, to);
    }
    return sum * (float(VCT_LAMP_POINTS) / float(LAMP_SAMPLES));
}

vec3 irradiance(vec3 position, vec3 normal)
{
    mat3 world_from_local = vct_axes_about(normal);
    vec3 at = (position - clips.origin_m) / set.texel_m;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < set.cone_count; i++) {
        vec4 met = vct_cone(light, at, normal, world_from_local * set.cones[i].xyz, set.offset, set.width_per_m,
                            set.last_mip, vct_start(vct.level, 0.0));
        sum += set.cones[i].w * (met.rgb * vct.light_scale + (1.0 - met.a) * frame.sky);
    }
    if (VCT_HAS_LAMPS) sum += lamps_at(at, normal);
    return min(sum, vec3(HALF_MAX));
}

const float ONE_SHEET = 0.9; // least cosine of the normals of voxels that are one sheet: 26 degrees
const float ONE_PLANE = 1.0; // voxels: how far they lie at most from the plane of the first

// The voxels of a block of 4 × 4 × 4: those of two texels along x have 16 bits and follow on each other.
struct block
{
    ivec3 corner;
    uvec2 bits;
    uvec4 first; // slots
};

void read_texels(ivec3 texel, out uint bits, out uint first)
{
    uint index = vct_texel_index(texel), shift = 8u * (index & 3u), word = mask[index >> 2];
    bits = word >> shift & 0xffffu;
    first = before[index >> 2] + uint(bitCount(word & ((1u << shift) - 1u)));
}

block block_at(ivec3 place)
{
    ivec3 texel = 2 * place;
    uvec4 bits, first;
    read_texels(texel, bits.x, first.x);
    read_texels(texel + ivec3(0, 1, 0), bits.y, first.y);
    read_texels(texel + ivec3(0, 0, 1), bits.z, first.z);
    read_texels(texel + ivec3(0, 1, 1), bits.w, first.w);
    return block(4 * place, bits.xz | bits.yw << 16u, first);
}

// Voxels are named by their bits, 0 to 63.
uint first_of(uvec2 bits)
{
    return uint(bits.x != 0u ? findLSB(bits.x) : 32 + findLSB(bits.y));
}

uvec2 bit_of(uint voxel)
{
    return uvec2(voxel < 32u ? 1u << voxel : 0u, voxel < 32u ? 0u : 1u << (voxel - 32u));
}

ivec3 place_of(block b, uint voxel)
{
    ivec3 low = ivec3(voxel) >> ivec3(0, 1, 2) & 1, high = ivec3(voxel) >> ivec3(3, 4, 5) & 1;
    return b.corner + 2 * high + low;
}

uint slot_of(block b, uint voxel)
{
    uint row = voxel >> 4;
    uint bits = (row < 2u ? b.bits.x : b.bits.y) >> (16u * (row & 1u)) & 0xffffu;
    uint first = row == 0u ? b.first.x : row == 1u ? b.first.y : row == 2u ? b.first.z : b.first.w;
    return min(first + uint(bitCount(bits & ((1u << (voxel & 15u)) - 1u))), vct.capacity);
}

// Voxels of one block that are parts of one sheet.
struct vct_part
{
    uvec2 bits;
    vec3 normal;
    vec3 position; // voxels from the block's corner × weight
    float weight;
    bvec2 covers; // whether there is a front, a back
};

// Those of `left` that have the normal of the first of them and lie in its plane.
vct_part part_of(block b, uvec2 left)
{
    vct_part part = vct_part(uvec2(0u), vec3(0.0), vec3(0.0), 0.0, bvec2(false));
    vec3 first_normal = vec3(0.0), first_position = vec3(0.0);
    bool first = true;
    for (uvec2 rest = left; rest != uvec2(0u);) {
        uint voxel = first_of(rest), slot = slot_of(b, voxel);
        rest &= ~bit_of(voxel);
        if (slot == vct.capacity) { // it has none
            part.bits |= bit_of(voxel);
            continue;
        }
        vct_surface surface = vct_unpack_surface(texelFetch(vct_surfaces, vct_record_place(slot), 0));
        vec3 position = vec3(place_of(b, voxel) - b.corner) + 0.5 + surface.position;
        if (first) {
            first_normal = surface.normal;
            first_position = position;
        } else if (dot(surface.normal, first_normal) < ONE_SHEET ||
                   abs(dot(position - first_position, first_normal)) > ONE_PLANE) {
            continue;
        }
        first = false;
        part.bits |= bit_of(voxel);
        part.normal += surface.weight * surface.normal;
        part.position += surface.weight * position;
        part.weight += surface.weight;
        part.covers.x = part.covers.x || surface.covers.x;
        part.covers.y = part.covers.y || surface.covers.y;
    }
    return part;
}

// One side after the other, in a loop that ends where no invocation of a group has a second one.
void gather(block b, vct_part part, out vec3 front, out vec3 back)
{
    front = back = vec3(0.0);
    if (part.normal == vec3(0.0)) return;
    vec3 position = vct_world_from_voxels(vec3(b.corner) + part.position / part.weight);
    vec3 normal = normalize(part.normal);
    for (int side = part.covers.x ? 0 : 1; side < (part.covers.y ? 2 : 1); side++) {
        vec3 e = irradiance(position, side == 0 ? normal : -normal);
        if (side == 0) front = e;
        else back = e;
    }
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= state.count[1]) return;
    uint second_level = uint(vct.volume_dim * vct.volume_dim * vct.volume_dim);
    block b = block_at(vct_unpack_texel(texels[second_level + i]));
    for (uvec2 left = b.bits; left != uvec2(0u);) {
        vct_part part = part_of(b, left);
        vec3 front, back;
        gather(b, part, front, back);
        left &= ~part.bits;
        while (part.bits != uvec2(0u)) {
            uint voxel = first_of(part.bits), slot = slot_of(b, voxel);
            part.bits &= ~bit_of(voxel);
            if (slot == vct.capacity) continue;
            uint to = slot * VCT_BROUGHT_WORDS;
            brought[to] = packHalf2x16(front.rg);
            brought[to + 1u] = packHalf2x16(vec2(front.b, back.r));
            brought[to + 2u] = packHalf2x16(back.gb);
        }
    }
}
