#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Outgoing radiance L = direct (with emission and sky) + diffuse lobe (brdf.glsl) · E · visibility
// + specular, and the tone-mapped display image. The METER variant counts luminances of a grid of
// pixels for automatic exposure instead, before the exposure of the display image is known.
#include "frame/frame.glsl"
#include "frame/composite/composite_shared.h"
#include "frame/composite/exposure_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = COMPOSITE_CONSTANT_IRRADIANCE) const bool HAS_IRRADIANCE = false;
layout(constant_id = COMPOSITE_CONSTANT_SPECULAR) const bool HAS_SPECULAR = false;
layout(constant_id = COMPOSITE_CONSTANT_VISIBILITY) const bool HAS_VISIBILITY = false;
layout(constant_id = COMPOSITE_CONSTANT_INDIRECT) const bool WRITES_INDIRECT = false;
layout(constant_id = COMPOSITE_CONSTANT_DISPLAY) const bool WRITES_DISPLAY = false;
layout(constant_id = COMPOSITE_CONSTANT_METER) const bool METERS = false;
layout(constant_id = COMPOSITE_CONSTANT_AGX) const bool DISPLAY_AGX = false;
layout(constant_id = COMPOSITE_CONSTANT_LINEAR) const bool DISPLAY_LINEAR = false;

#include "frame/composite/display.glsl"

layout(set = 0, binding = 1) uniform sampler2D direct_layer;
layout(set = 0, binding = 2) uniform sampler2D albedo_layer;
layout(set = 0, binding = 3) uniform sampler2D irradiance_layer;
layout(set = 0, binding = 4) uniform sampler2D specular_layer;
layout(set = 0, binding = 5) uniform sampler2D visibility_layer;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D color_layer;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D indirect_layer;
layout(set = 0, binding = 8, rgba8) uniform writeonly image2D display_layer;
layout(set = 0, binding = 9, scalar) readonly buffer exposure_state
{
    exposure_values state;
};
layout(set = 0, binding = 10, scalar) buffer exposure_histogram
{
    exposure_counts histogram;
};

layout(push_constant, scalar) uniform push_block
{
    composite_push push;
};

// direct: of direct/direct.comp. Irradiance may be negative: FRAME_NEEDS_DIRECT_IRRADIANCE.
vec3 indirect_light(ivec2 pixel, vec4 direct)
{
    vec3 light = vec3(0.0);
    vec4 albedo = texelFetch(albedo_layer, pixel, 0); // alpha: 0 where no surface is visible
    if (HAS_IRRADIANCE) {
        vec3 diffuse_lobe = albedo.rgb * (direct.a * INV_PI);
        light = diffuse_lobe * texelFetch(irradiance_layer, pixel, 0).rgb;
        if (HAS_VISIBILITY) light *= texelFetch(visibility_layer, pixel, 0).r;
    }
    if (HAS_SPECULAR) light += texelFetch(specular_layer, pixel, 0).rgb;
    return frame_is_lit(albedo.a) ? min(light, vec3(HALF_MAX)) : vec3(0.0);
}

// Unlit materials and pixels without a surface are not metered.
void meter(ivec2 pixel, vec3 radiance)
{
    if (!frame_is_lit(texelFetch(albedo_layer, pixel, 0).a)) return;
    float l = dot(radiance, vec3(0.2126, 0.7152, 0.0722));
    if (l > 0.0) {
        uint bin = max(floatBitsToUint(l) >> EXPOSURE_BIN_SHIFT, EXPOSURE_FIRST_BIN);
        atomicAdd(histogram.lit[min(bin - EXPOSURE_FIRST_BIN, EXPOSURE_BINS - 1)], 1);
    } else {
        atomicAdd(histogram.black, 1);
    }
}

void main()
{
    ivec2 size = ivec2(frame.width, frame.height);
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (METERS) pixel *= int(push.stride);
    if (any(greaterThanEqual(pixel, size))) return;
    if (METERS) pixel = min(pixel + int(push.stride) / 2, size - 1);
    vec4 direct = texelFetch(direct_layer, pixel, 0);
    vec3 indirect = vec3(0.0);
    if (HAS_IRRADIANCE || HAS_SPECULAR) indirect = indirect_light(pixel, direct);
    vec3 radiance = min(direct.rgb + indirect, vec3(HALF_MAX));
    if (METERS) {
        meter(pixel, radiance);
        return;
    }
    imageStore(color_layer, pixel, vec4(radiance, 1.0));
    if (WRITES_INDIRECT) imageStore(indirect_layer, pixel, vec4(indirect, 1.0));
    if (WRITES_DISPLAY)
        imageStore(display_layer, pixel, display_encoded(display_tone_mapped(radiance, state.ev)));
}
