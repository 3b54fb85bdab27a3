// Debug views of the rays: white where a ray has a certain hit, or brighter with its distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "frame/frame.glsl"
#define SSR_BINDING 1
#include "techniques/ssr/ssr_block.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = SSR_CONSTANT_STEP) const int STEP = 1;

layout(push_constant, scalar) uniform push_block
{
    ssr_view_push push;
};
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D hits;
layout(set = 0, binding = 4) uniform sampler2D rays;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D target;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float confidence = texelFetch(rays, pixel / STEP, 0).a, value = confidence;
    if (push.distance != 0u && confidence > 0.0) {
        vec3 position =
            frame_world_position(frame_uv(uvec2(pixel)), max(texelFetch(depth, pixel, 0).r, 1e-12));
        float distance_m = distance(texelFetch(hits, pixel / STEP, 0).xyz, position);
        value = distance_m / (distance_m + 1.0);
    }
    imageStore(target, pixel, vec4(vec3(value * frame.unlit_white), 1.0));
}
