// Reflected flux times the distance to the box (scaled lumen · m) over all reflective shadow maps,
// as AMBIENT_GROUPS partial sums. The order of summation is fixed, so that equal frames have equal
// bits.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm.glsl"
#include "techniques/ambient/ambient_tree.glsl"

layout(local_size_x = AMBIENT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    ambient_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer rsm_faces
{
    rsm_face faces[];
};
layout(set = 0, binding = 1) uniform sampler2DArray rsm_depth;
layout(set = 0, binding = 2) uniform sampler2DArray rsm_normal;
layout(set = 0, binding = 3) uniform sampler2DArray rsm_flux;
layout(set = 0, binding = 4, scalar) writeonly buffer ambient_partials
{
    vec3 partials[];
};

const float FAR = 1e30;

// Metres. emitters.c has the same function for emissive surfaces.
float distance_to_exit(vec3 from, vec3 direction)
{
    vec3 distance_m =
        max((mix(push.box_min, push.box_max, greaterThan(direction, vec3(0.0))) - from) / direction,
            vec3(0.0));
    distance_m = mix(distance_m, vec3(FAR), equal(direction, vec3(0.0)));
    return min(distance_m.x, min(distance_m.y, distance_m.z));
}

vec3 block_flux(uint block)
{
    uint per_face = push.blocks_across * push.blocks_across;
    int layer = int(block / per_face);
    uint within = block % per_face;
    ivec2 first = ivec2(within % push.blocks_across, within / push.blocks_across) * AMBIENT_TEXELS;
    ivec2 last = min(first + AMBIENT_TEXELS, ivec2(push.rsm_size));
    rsm_face face = faces[layer];
    vec3 sum = vec3(0.0);
    for (int y = first.y; y < last.y; y++) {
        for (int x = first.x; x < last.x; x++) {
            rsm_texel light =
                rsm_fetch(face, ivec2(x, y), layer, push.rsm_size, rsm_depth, rsm_normal, rsm_flux);
            if (light.valid) sum += light.flux * distance_to_exit(light.position, light.normal);
        }
    }
    return sum;
}

void main()
{
    vec3 sum = vec3(0.0);
    for (uint i = gl_GlobalInvocationID.x; i < push.blocks; i += AMBIENT_LOCAL * AMBIENT_GROUPS)
        sum += block_flux(i);
    vec3 total = workgroup_sum(sum);
    if (gl_LocalInvocationIndex == 0u) partials[gl_WorkGroupID.x] = total;
}
