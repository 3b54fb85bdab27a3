#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Outgoing radiance L = direct (with emission and sky) + diffuse lobe (brdf.glsl) · E · visibility
// + specular, and the tone-mapped display image.
#define GGX_ALBEDO_BINDING 11
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/composite/composite_shared.h"
#include "frame/composite/exposure_shared.h"
#include "frame/octahedral.glsl"
#include "image/tonemap.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = COMPOSITE_CONSTANT_IRRADIANCE) const bool HAS_IRRADIANCE = false;
layout(constant_id = COMPOSITE_CONSTANT_SPECULAR) const bool HAS_SPECULAR = false;
layout(constant_id = COMPOSITE_CONSTANT_VISIBILITY) const bool HAS_VISIBILITY = false;
layout(constant_id = COMPOSITE_CONSTANT_INDIRECT) const bool WRITES_INDIRECT = false;
layout(constant_id = COMPOSITE_CONSTANT_DISPLAY) const bool WRITES_DISPLAY = false;
layout(constant_id = COMPOSITE_CONSTANT_DIELECTRIC) const bool HAS_DIELECTRIC = false;

layout(set = 0, binding = 1) uniform sampler2D direct_layer;
layout(set = 0, binding = 2) uniform sampler2D albedo_layer;
layout(set = 0, binding = 3) uniform sampler2D material_layer;
layout(set = 0, binding = 4) uniform sampler2D irradiance_layer;
layout(set = 0, binding = 5) uniform sampler2D specular_layer;
layout(set = 0, binding = 6) uniform sampler2D visibility_layer;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D color_layer;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D indirect_layer;
layout(set = 0, binding = 9, rgba8) uniform writeonly image2D display_layer;
layout(set = 0, binding = 10, scalar) readonly buffer exposure_state
{
    exposure_values state;
};
layout(set = 0, binding = 12) uniform sampler2D depth_layer;
layout(set = 0, binding = 13) uniform sampler2D normal_layer;
layout(set = 0, binding = 14) uniform sampler2D dielectric_layer;

vec3 diffuse_lobe(ivec2 pixel, vec3 albedo)
{
    float depth = texelFetch(depth_layer, pixel, 0).r;
    if (!(depth > 0.0)) return vec3(0.0);
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), depth);
    vec3 normal = octahedral_decode(texelFetch(normal_layer, pixel, 0).rg);
    vec2 material = texelFetch(material_layer, pixel, 0).rg;
    float n_v = brdf_cosine(normal, normalize(frame.camera_position - position));
    vec4 dielectric =
        HAS_DIELECTRIC ? texelFetch(dielectric_layer, pixel, 0) : BRDF_DEFAULT_DIELECTRIC;
    return brdf_lobes_at(brdf_material_of(albedo, material, dielectric), n_v).diffuse;
}

vec3 indirect_light(ivec2 pixel)
{
    vec3 light = vec3(0.0);
    vec4 albedo = texelFetch(albedo_layer, pixel, 0); // alpha: 0 where no surface is visible
    if (HAS_IRRADIANCE) {
        light = diffuse_lobe(pixel, albedo.rgb) * texelFetch(irradiance_layer, pixel, 0).rgb;
        if (HAS_VISIBILITY) light *= texelFetch(visibility_layer, pixel, 0).r;
    }
    if (HAS_SPECULAR) light += texelFetch(specular_layer, pixel, 0).rgb;
    return frame_is_lit(albedo.a) ? min(light, vec3(HALF_MAX)) : vec3(0.0);
}

// IEC 61966-2-1.
vec3 srgb_encoded(vec3 linear)
{
    return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
               lessThanEqual(linear, vec3(0.0031308)));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(frame.width) || pixel.y >= int(frame.height)) return;
    vec3 radiance = texelFetch(direct_layer, pixel, 0).rgb;
    vec3 indirect = vec3(0.0);
    if (HAS_IRRADIANCE || HAS_SPECULAR) indirect = indirect_light(pixel);
    radiance = min(radiance + indirect, vec3(HALF_MAX));
    imageStore(color_layer, pixel, vec4(radiance, 1.0));
    if (WRITES_INDIRECT) imageStore(indirect_layer, pixel, vec4(indirect, 1.0));
    if (WRITES_DISPLAY) {
        vec3 display =
            tonemap_pbr_neutral(radiance * (exposure_scale(state.ev) / frame.radiance_scale));
        imageStore(display_layer, pixel, vec4(srgb_encoded(clamp(display, 0.0, 1.0)), 1.0));
    }
}
