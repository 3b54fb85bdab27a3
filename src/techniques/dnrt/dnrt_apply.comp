// Adds to each pixel's irradiance what objects change: their volumes times weights of its normal,
// (n_o·n)₊ of one volume (Giuffrida 2016, equation 16). Workgroups are the tiles of the image that
// some object reaches. A pixel that none changes is not written.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/dnrt/dnrt_shared.h"

#include "techniques/dnrt/dnrt_receiver.glsl"

layout(local_size_x = DNRT_TILE, local_size_y = DNRT_TILE) in;

layout(push_constant, scalar) uniform push_block
{
    dnrt_apply_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
#ifdef DNRT_ID
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
#endif
layout(set = 0, binding = 4, scalar) readonly buffer dnrt_objects
{
    dnrt_gpu_object object_table[];
};
layout(set = 0, binding = 5, scalar) readonly buffer dnrt_tiles
{
    uint tile_table[]; // [group][1 + words]: the tile, and a bit for each object
};
layout(set = 0, binding = 6) uniform sampler3D volumes;
layout(set = 0, binding = 7, rgba16f) uniform image2D irradiance;

vec3 change_by(dnrt_gpu_object object, vec3 position, vec3 n)
{
    dnrt_receiver at = dnrt_receiver_of(object, position, n);
    vec3 weights, sum = vec3(0.0);
    if (!dnrt_weights(object, at, push.fade, weights)) return sum;
    vec3 texel = vec3(object.slot_x, object.slot_y, object.slot_z) + 0.5 +
                 dnrt_sample_of(object, at, push.size);
    for (uint i = 0; i < LOOKUPS; i++) {
        vec3 slot = vec3(float(dnrt_volume_of(at, i) * push.size), 0.0, 0.0);
        sum += weights[i] *
               textureLod(volumes, (texel + slot) / vec3(textureSize(volumes, 0)), 0.0).rgb;
    }
    return sum;
}

bool is_own(dnrt_gpu_object object, uint instance)
{
    return instance - object.first_instance < object.instance_count;
}

void main()
{
    uint group = gl_WorkGroupID.x * (1u + push.words);
    uint tile = tile_table[group];
    ivec2 pixel = ivec2(DNRT_TILE * uvec2(tile % push.tiles_x, tile / push.tiles_x) +
                        gl_LocalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    if (z <= 0.0) return;
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
#ifdef DNRT_ID
    uint instance = texelFetch(id, pixel, 0).r - 1u;
#else
    uint instance = ~0u;
#endif
    vec3 change = vec3(0.0);
    for (uint w = 0; w < push.words; w++) {
        for (uint bits = tile_table[group + 1u + w]; bits != 0u; bits &= bits - 1u) {
            dnrt_gpu_object object = object_table[32u * w + uint(findLSB(bits))];
            if (!is_own(object, instance)) change += change_by(object, position, n);
        }
    }
    if (change == vec3(0.0)) return;
    vec4 before = imageLoad(irradiance, pixel);
    imageStore(irradiance, pixel,
               vec4(clamp(before.rgb + change, vec3(0.0), vec3(HALF_MAX)), before.a));
}
