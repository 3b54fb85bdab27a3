// Light that other voxels and the sky bring to each voxel, by cones: irradiance on both sides of its sheet. What
// surfaces that glow bring on their straight way, and with more bounces all that the voxels sent out in the last
// frame. Voxels of one texel that are parts of one sheet get what is brought to their middle.
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
layout(set = 0, binding = 6, scalar) readonly buffer vct_sums { uint sums[]; };
layout(set = 0, binding = 7, scalar) writeonly buffer vct_brought { uint brought[]; };
layout(set = 0, binding = 8, scalar) readonly buffer vct_mask { uint mask[]; };
layout(set = 0, binding = 9, scalar) readonly buffer vct_before { uint before[]; };

#include "techniques/vct/vct_axes.glsl"
#include "techniques/vct/vct_trace.glsl"

vec3 irradiance(vec3 position, vec3 normal)
{
    mat3 world_from_local = vct_axes_about(normal);
    vec3 from = (position - vct.origin_m) / set.texel_m + set.offset * normal;
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < set.cone_count; i++) {
        vec4 met = vct_trace(light, from, normal, world_from_local * set.cones[i].xyz, set.width_per_m, set.last_mip);
        sum += set.cones[i].w * (met.rgb * vct.light_scale + (1.0 - met.a) * frame.sky);
    }
    return min(sum, vec3(HALF_MAX));
}

const float ONE_SHEET = 0.9; // least cosine of the normals of voxels that are one sheet: 26 degrees

// The voxels of a texel: a bit each, and the slot of the first.
struct eight
{
    uint bits, first;
};

eight voxels_of(ivec3 texel)
{
    uint index = vct_texel_index(texel), shift = 8u * (index & 3u), word = mask[index >> 2];
    eight e;
    e.bits = word >> shift & 255u;
    e.first = before[index >> 2] + uint(bitCount(word & ((1u << shift) - 1u)));
    uint room = vct.capacity - min(e.first, vct.capacity);
    while (uint(bitCount(e.bits)) > room) e.bits ^= 1u << findMSB(e.bits); // the last ones have no slots
    return e;
}

uint slot_of(eight e, uint bit)
{
    return e.first + uint(bitCount(e.bits & ((1u << bit) - 1u)));
}

vec3 signed_sum(uint at)
{
    return vec3(int(sums[at]), int(sums[at + 1u]), int(sums[at + 2u]));
}

// Voxels of one texel that are parts of one sheet.
struct vct_part
{
    uint bits;
    vec3 normal, position; // voxels from the grid's corner; sums with weights
    float weight;
    bvec2 covers;          // whether there is a front, a back
};

// Those of `left` whose normals are near to that of the first.
vct_part part_of(eight e, uint left, ivec3 corner)
{
    vct_part part = vct_part(0u, vec3(0.0), vec3(0.0), 0.0, bvec2(false));
    uint lead = uint(findLSB(left));
    vec3 first = signed_sum(slot_of(e, lead) * VCT_SUM_WORDS + VCT_SUM_NORMAL);
    for (uint bits = left; bits != 0u; bits &= bits - 1u) {
        uint bit = uint(findLSB(bits)), at = slot_of(e, bit) * VCT_SUM_WORDS;
        vec3 normal = signed_sum(at + VCT_SUM_NORMAL);
        float cosine = dot(normal, first) * inversesqrt(max(dot(normal, normal) * dot(first, first), 1.0));
        if (bit != lead && cosine < ONE_SHEET) continue;
        float weight = max(float(sums[at + VCT_SUM_WEIGHT]), 1.0);
        vec3 centre = vec3(corner + (ivec3(bit) >> ivec3(0, 1, 2) & 1)) + 0.5;
        part.bits |= 1u << bit;
        part.normal += normal;
        part.position += weight * centre + signed_sum(at + VCT_SUM_POSITION) / VCT_POSITION_ONE;
        part.weight += weight;
        part.covers.x = part.covers.x || sums[at + VCT_SUM_FRONTS] > 0u;
        part.covers.y = part.covers.y || sums[at + VCT_SUM_BACKS] > 0u;
    }
    return part;
}

// One side after the other, in a loop that ends where no invocation of a group has a second one.
void gather(vct_part part, out vec3 front, out vec3 back)
{
    front = back = vec3(0.0);
    if (part.normal == vec3(0.0)) return;
    vec3 position = vct_world_from_voxels(part.position / part.weight), normal = normalize(part.normal);
    for (int side = part.covers.x ? 0 : 1; side < (part.covers.y ? 2 : 1); side++) {
        vec3 e = irradiance(position, side == 0 ? normal : -normal);
        if (side == 0) front = e;
        else back = e;
    }
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= state.count[0]) return;
    ivec3 texel = vct_unpack_texel(texels[i]);
    eight e = voxels_of(texel);
    for (uint left = e.bits; left != 0u;) {
        vct_part part = part_of(e, left, 2 * texel);
        vec3 front, back;
        gather(part, front, back);
        left &= ~part.bits;
        for (uint bits = part.bits; bits != 0u; bits &= bits - 1u) {
            uint to = slot_of(e, uint(findLSB(bits))) * VCT_BROUGHT_WORDS;
            brought[to] = packHalf2x16(front.rg);
            brought[to + 1u] = packHalf2x16(vec2(front.b, back.r));
            brought[to + 2u] = packHalf2x16(back.gb);
        }
    }
}
