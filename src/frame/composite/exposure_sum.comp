#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Sum of log2 luminances per work group. The order of additions depends on the image size only, so
// equal images give equal bits. The first pass stores its log2 luminances for the second.
#include "frame/frame.glsl"
#include "frame/composite/exposure_shared.h"
#include "frame/composite/exposure_reduce.glsl"

layout(local_size_x = EXPOSURE_THREADS) in;

layout(set = 0, binding = 1, scalar) readonly buffer exposure_state
{
    exposure_values state;
};
layout(set = 0, binding = 2, scalar) writeonly buffer exposure_sums
{
    vec2 sums[];
};
layout(set = 0, binding = 3) uniform sampler2D direct_layer;
layout(set = 0, binding = 4) uniform sampler2D albedo_layer;
layout(set = 0, binding = 5) uniform sampler2D material_layer;
// xy: log2 luminance as two half floats (22 bits); z: kind of pixel.
layout(set = 0, binding = 6, rgba16f) uniform image2D metered_layer;

layout(constant_id = EXPOSURE_CONSTANT_SECOND_PASS) const bool SECOND_PASS = false;

const float INV_PI = 0.31830988618;
const float NO_SURFACE = 0.0, UNLIT = 1.0, LIT = 2.0;

layout(push_constant, scalar) uniform push_block
{
    exposure_push push;
};

// Metered radiance of a pixel. The direct layer lacks light from emissive surfaces: a uniform
// irradiance stands in for it, the same for every technique.
vec3 metered_radiance(ivec2 pixel)
{
    vec3 radiance = texelFetch(direct_layer, pixel, 0).rgb;
    vec3 albedo = texelFetch(albedo_layer, pixel, 0).rgb;
    float metallic = texelFetch(material_layer, pixel, 0).g;
    return radiance + albedo * ((1.0 - metallic) * INV_PI) * push.emitted;
}

// x: log2 of the luminance, y: kind of pixel. Sky and unlit materials are not metered.
vec2 meter(ivec2 pixel)
{
    float l = dot(metered_radiance(pixel), vec3(0.2126, 0.7152, 0.0722));
    bool lit = l > 0.0 && !isinf(l);
    float kind = !frame_is_lit(texelFetch(albedo_layer, pixel, 0).a) ? NO_SURFACE
                 : lit                                               ? LIT
                                                                     : UNLIT;
    return vec2(kind == LIT ? log2(l) : 0.0, kind);
}

// x: log2 of the metered luminance; y: 1 if the pixel is metered. Pass 1: lit pixels; pass 2: all
// surface pixels, clamped to the floor.
vec2 pixel_term(ivec2 pixel)
{
    if (SECOND_PASS) {
        vec4 stored = imageLoad(metered_layer, pixel);
        float value =
            stored.z == LIT ? max(stored.x + stored.y, state.floor_log2) : state.floor_log2;
        return stored.z == NO_SURFACE ? vec2(0.0) : vec2(value, 1.0);
    }
    vec2 result = meter(pixel);
    float high = unpackHalf2x16(packHalf2x16(vec2(result.x, 0.0))).x;
    imageStore(metered_layer, pixel, vec4(high, result.x - high, result.y, 0.0));
    return vec2(result.x, result.y == LIT ? 1.0 : 0.0);
}

void main()
{
    uint count = frame.width * frame.height;
    uint stride = push.groups * EXPOSURE_THREADS;
    // Incremental pixel coordinates: software drivers execute integer division one lane at a time.
    uvec2 step = uvec2(stride % frame.width, stride / frame.width);
    uvec2 pixel =
        uvec2(gl_GlobalInvocationID.x % frame.width, gl_GlobalInvocationID.x / frame.width);
    vec2 sum = vec2(0.0);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
        sum += pixel_term(ivec2(pixel));
        pixel += step;
        if (pixel.x >= frame.width) pixel = uvec2(pixel.x - frame.width, pixel.y + 1u);
    }
    sum = sum_of_group(sum);
    if (gl_LocalInvocationID.x == 0) sums[gl_WorkGroupID.x] = sum;
}
