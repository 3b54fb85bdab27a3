// Light that texels reflect before any bounce: of all lights, with shadows, of emissive surfaces
// and of the sky. In scaled lumen: radiosity times area.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SHADOW_FACES_BINDING     2
#define SHADOW_MAPS_BINDING      3
#define SHADOW_SUN_MAPS_BINDING  12
#define RADIOSITY_TEXELS_BINDING 4
#define FRAME_CONSTANTS_COPIED
#include "frame/environment.glsl"
#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#include "techniques/common/texel_light.glsl"
#include "techniques/radiosity/radiosity_texels.glsl"

layout(local_size_x = RADIOSITY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_direct_push push_of_all;
};
radiosity_direct_push push; // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 5, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D radiosity_flux;

void main()
{
    frame = frame_block;
    push = push_of_all;
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = push.first + gl_GlobalInvocationID.x;
    vec4 place = radiosity_texel_part(i, push.texels, RADIOSITY_POSITION); // w: area
    vec3 normal = radiosity_texel_part(i, push.texels, RADIOSITY_NORMAL).xyz;
    vec4 reflectance = radiosity_texel_part(i, push.texels, RADIOSITY_REFLECTANCE);
    vec3 irradiance = vec3(0.0);
    if (place.w > 0.0) {
        float emitters = push.emitters * frame.radiance_scale;
        for (int c = 0; c < 3; c++)
            irradiance[c] = radiosity_unbounced(i, push.texels, c, environment_mean(), emitters).x;
        // Shading normals n of mean cosine c to the surface's receive c of the light of a
        // direction, and E(n) = (E + n·V)/2 of light of all: (1 + c)/2.
        irradiance *= 0.5 + 0.5 * reflectance.w;
        for (uint k = 0; k < frame.light_count; k++)
            irradiance +=
                reflectance.w * texel_irradiance(place.xyz, normal, place.w, frame_light_table[k],
                                                 push.shadow_radius);
    }
    imageStore(radiosity_flux, light_map_at(i), vec4(place.w * reflectance.rgb * irradiance, 0.0));
}
