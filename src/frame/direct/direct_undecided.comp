#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// The shadow test of the pixels that direct.comp listed: those in shadow keep their emission alone,
// and have no irradiance.
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/shadow/shadow_resolved.glsl"
#include "frame/direct/direct_sun.glsl"

layout(local_size_x = DIRECT_LIST_GROUP) in;

layout(set = 0, binding = 1) uniform sampler2D depth_layer;
layout(set = 0, binding = 2) uniform sampler2D normal_layer;
layout(set = 0, binding = 3) uniform sampler2D emissive_layer;
layout(set = 0, binding = 4, rgba16f) uniform image2D direct_layer;
layout(set = 0, binding = 5, scalar) readonly buffer direct_list
{
    direct_list_header list;
    uint list_pixels[]; // y << 16 | x
};
#if DIRECT_IRRADIANCE
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D direct_irradiance_layer;
#endif

layout(constant_id = DIRECT_CONSTANT_EMISSION) const bool HAS_EMISSION = true;

void main()
{
    frame = frame_block;
    sun = sun_block;
    if (gl_GlobalInvocationID.x >= list.count) return;
    uint packed = list_pixels[gl_GlobalInvocationID.x];
    ivec2 pixel = ivec2(packed & 0xffffu, packed >> 16);
    vec3 ray = frame_view_ray(frame_uv(uvec2(pixel)));
    float view_distance = frame_view_distance(texelFetch(depth_layer, pixel, 0).r);
    vec3 normal = octahedral_decode(texelFetch(normal_layer, pixel, 0).rg);
    shadow_receiver receiver = sun_receiver(ray, view_distance, normal);
    if (shadow_resolved(shadow_sun_depths, receiver, true) > 0.0) return;
    vec3 emission = vec3(0.0);
    if (HAS_EMISSION)
        emission =
            min(texelFetch(emissive_layer, pixel, 0).rgb * frame.emissive_scale, vec3(HALF_MAX));
    imageStore(direct_layer, pixel, vec4(emission, imageLoad(direct_layer, pixel).a));
#if DIRECT_IRRADIANCE
    imageStore(direct_irradiance_layer, pixel, vec4(vec3(0.0), 1.0));
#endif
}
