#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Any layer as the display image. Without a surface, layers of surfaces are black.
#include "frame/frame.glsl"
#include "frame/composite/display_shared.h"
#include "frame/composite/exposure_shared.h"
#include "frame/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = DISPLAY_CONSTANT_AGX) const bool DISPLAY_AGX = false;
layout(constant_id = DISPLAY_CONSTANT_LINEAR) const bool DISPLAY_LINEAR = false;

#include "frame/composite/display.glsl"

layout(set = 0, binding = 1) uniform sampler2D shown_layer;
layout(set = 0, binding = 2) uniform sampler2D albedo_layer;
layout(set = 0, binding = 3, rgba8) uniform writeonly image2D display_layer;
layout(set = 0, binding = 4, scalar) readonly buffer exposure_state
{
    exposure_values state;
};

layout(push_constant, scalar) uniform push_block
{
    display_push push;
};

vec3 motion_color(vec3 motion)
{
    motion.xy *= vec2(frame.width, frame.height);
    return 0.5 + 0.5 * motion / (1.0 + abs(motion));
}

vec3 surface_color(vec4 value)
{
    switch (push.kind) {
    case DISPLAY_NORMAL:
        return 0.5 + 0.5 * octahedral_decode(value.xy);
    case DISPLAY_DEPTH:
        return vec3(1.0 / (1.0 + frame_view_distance(value.r)));
    default:
        return motion_color(value.xyz);
    }
}

vec3 linear_display(ivec2 pixel, vec4 value)
{
    switch (push.kind) {
    case DISPLAY_RADIANCE:
        return display_tone_mapped(value.rgb, state.ev);
    case DISPLAY_IRRADIANCE:
        return display_tone_mapped(value.rgb * INV_PI, state.ev);
    case DISPLAY_COLOR:
        return value.rgb;
    case DISPLAY_GREY:
        return value.rrr;
    default:
        // The alpha is 0 without a surface.
        return texelFetch(albedo_layer, pixel, 0).a > 0.0 ? surface_color(value) : vec3(0.0);
    }
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec3 linear = linear_display(pixel, texelFetch(shown_layer, pixel, 0));
    imageStore(display_layer, pixel, display_encoded(clamp(linear, 0.0, 1.0)));
}
