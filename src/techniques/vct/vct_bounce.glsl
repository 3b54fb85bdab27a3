// Light that other voxels and the sky bring to each voxel, by cones: irradiance on both sides of its sheet. What
// surfaces that glow bring on their straight way, and with more bounces all that the voxels sent out in the last
// frame.
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
layout(set = 0, binding = 4, scalar) readonly buffer vct_list { uint list[]; };
layout(set = 0, binding = 5, scalar) readonly buffer vct_sums { uint sums[]; };
layout(set = 0, binding = 6, scalar) readonly buffer vct_arguments { uint groups[3]; uint listed; uint left_out; };
layout(set = 0, binding = 7, scalar) writeonly buffer vct_brought { uint brought[]; };

#include "techniques/vct/vct_axes.glsl"
#include "techniques/vct/vct_sums.glsl"
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

void main()
{
    uint slot = gl_GlobalInvocationID.x;
    if (slot >= listed) return;
    vct_sheet sheet = vct_sheet_of(slot);
    bool knows_sides = sheet.normal != vec3(0.0);
    bvec2 lit = bvec2(knows_sides && sheet.opacity.x > 0.0, knows_sides && sheet.opacity.y > 0.0);
    // One side after the other in a loop, which ends where no invocation of a group has a second one.
    vec3 front = vec3(0.0), back = vec3(0.0);
    for (int side = lit.x ? 0 : 1; side < (lit.y ? 2 : 1); side++) {
        vec3 e = irradiance(sheet.position, side == 0 ? sheet.normal : -sheet.normal);
        if (side == 0) front = e;
        else back = e;
    }
    uint to = slot * VCT_BROUGHT_WORDS;
    brought[to] = packHalf2x16(front.rg);
    brought[to + 1u] = packHalf2x16(vec2(front.b, back.r));
    brought[to + 2u] = packHalf2x16(back.gb);
}
