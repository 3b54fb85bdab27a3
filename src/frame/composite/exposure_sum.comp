#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// A sum of log2 luminances for each group of threads. The order of additions depends on the image's
// size alone, so equal images give equal bits. The first round leaves what it has metered for the
// second one.
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
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
// The logarithm as two half floats, 22 bits; what the pixel is.
layout(set = 0, binding = 6, rgba16f) uniform image2D metered_layer;

layout(constant_id = 0) const bool SECOND_ROUND = false;

const float NO_SURFACE = 0.0, UNLIT = 1.0, LIT = 2.0;

layout(push_constant, scalar) uniform push_block
{
    exposure_push push;
};

// What a pixel is metered as. The direct image has emissive surfaces but not what they light: that
// is taken as if it fell evenly on everything, whichever technique lights the frame.
vec3 metered(ivec2 pixel)
{
    vec3 radiance = texelFetch(direct_layer, pixel, 0).rgb;
    float metallic = texelFetch(material_layer, pixel, 0).g;
    return radiance + brdf_diffuse(texelFetch(albedo_layer, pixel, 0).rgb, metallic) * push.emitted;
}

// x: log2 of the luminance, y: what the pixel is. The sky and the void behind the scene do not
// count.
vec2 meter(ivec2 pixel)
{
    float l = dot(metered(pixel), vec3(0.2126, 0.7152, 0.0722));
    bool lit = l > 0.0 && !isinf(l);
    float kind = texelFetch(albedo_layer, pixel, 0).a == 0.0 ? NO_SURFACE : lit ? LIT : UNLIT;
    return vec2(kind == LIT ? log2(l) : 0.0, kind);
}

// x: log2 of what the pixel counts as; y: 1 where it counts. Of lit pixels first, then of all, with
// the floor.
vec2 pixel_term(ivec2 pixel)
{
    if (SECOND_ROUND) {
        vec4 left = imageLoad(metered_layer, pixel);
        float value = left.z == LIT ? max(left.x + left.y, state.floor_log2) : state.floor_log2;
        return left.z == NO_SURFACE ? vec2(0.0) : vec2(value, 1.0);
    }
    vec2 found = meter(pixel);
    float high = unpackHalf2x16(packHalf2x16(vec2(found.x, 0.0))).x;
    imageStore(metered_layer, pixel, vec4(high, found.x - high, found.y, 0.0));
    return vec2(found.x, found.y == LIT ? 1.0 : 0.0);
}

void main()
{
    uint count = frame.width * frame.height;
    uint stride = push.groups * EXPOSURE_THREADS;
    // Stepped through row by row, without a division for each pixel, which software drivers do one
    // by one.
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
