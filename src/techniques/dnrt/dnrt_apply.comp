// Adds to each pixel's irradiance what objects change: (n_o·n)₊ times their volumes (Giuffrida
// 2016, equation 16). Workgroups are the tiles of the image that some object reaches. A pixel that
// none changes is not written.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/dnrt/dnrt_shared.h"

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

// Between the border of the inner volume, at 1, and the outer one's: the inverse square of the
// distance, less its value at the end.
float fall_off(float distance)
{
    if (distance <= 1.0) return 1.0;
    float end = 1.0 / (push.fade * push.fade);
    return max((1.0 / (distance * distance) - end) / (1.0 - end), 0.0);
}

vec3 change_by(dnrt_gpu_object object, vec3 position, vec3 n)
{
    vec3 to_centre = object.centre - position;
    float distance = length(to_centre);
    float cosine = dot(to_centre, n) / max(distance, 1e-12);
    if (cosine <= 0.0 || object.shape < 0) return vec3(0.0);
    vec3 at = -vec3(dot(to_centre, object.axis[0]), dot(to_centre, object.axis[1]),
                    dot(to_centre, object.axis[2])) /
              object.half_m;
    float border = max(abs(at.x), max(abs(at.y), abs(at.z)));
    if (border >= max(push.fade, 1.0)) return vec3(0.0);
    at /= max(border, 1.0);
    vec3 texel = vec3(object.slot_x, object.slot_y, object.slot_z) + 0.5 +
                 (0.5 * at + 0.5) * float(push.size - 1u);
    vec3 volume = textureLod(volumes, texel / vec3(textureSize(volumes, 0)), 0.0).rgb;
    return (cosine * fall_off(border)) * volume;
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
