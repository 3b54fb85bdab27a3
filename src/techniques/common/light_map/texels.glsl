// The tables of texels and their shares of the sky (texels.h), and of painted light (paint.h).
// Binding numbers: LIGHT_MAP_TEXELS_BINDING, _SKY_BINDING, _PATCHES_BINDING, _PAINT_BINDING.
#ifndef AG_LIGHT_MAP_TEXELS_GLSL
#define AG_LIGHT_MAP_TEXELS_GLSL

#include "frame/environment.glsl"
#include "techniques/common/light_map/table.glsl"

layout(set = 0, binding = LIGHT_MAP_TEXELS_BINDING,
       rgba32f) uniform readonly image2D light_map_texels;
layout(set = 0, binding = LIGHT_MAP_SKY_BINDING, rgba32ui) uniform readonly uimage2D light_map_sky;
layout(set = 0, binding = LIGHT_MAP_PATCHES_BINDING, scalar) uniform frame_environment_patches
{
    vec4 environment_patches[FRAME_ENVIRONMENT_PATCHES]; // scaled radiance
};
layout(set = 0, binding = LIGHT_MAP_PAINT_BINDING,
       rgba32f) uniform readonly image2D light_map_paint; // [texel] lux

vec4 light_map_texel_part(uint texel, uint texels, int part)
{
    return imageLoad(light_map_texels, light_map_at(part * texels + texel));
}

// Mean radiance of the environment by the texel's shares of its patches.
vec3 light_map_sky_radiance(uint texel, uint texels, light_map_sources sources)
{
    vec3 sum = sources.sky_words == 0u ? environment_mean() : vec3(0.0);
    for (uint k = 0u; k < sources.sky_words; k++) {
        uvec4 word = imageLoad(light_map_sky, light_map_at(k * texels + texel));
        for (uint i = 0u; i < 4u; i++) {
            vec4 share = unpackUnorm4x8(word[i]);
            for (uint b = 0u; b < 4u; b++)
                sum += share[b] * environment_patches[16u * k + 4u * i + b].rgb;
        }
    }
    return sum;
}

// Irradiance x and vector irradiance yzw, by colour.
vec4[3] light_map_emitted_light(uint texel, uint texels, light_map_sources sources)
{
    vec4 light[3];
    for (int c = 0; c < 3; c++)
        light[c] = light_map_texel_part(texel, texels, TEXEL_EMITTED_0 + c) *
                   (sources.emitters * frame.radiance_scale);
    return light;
}

vec4[3] light_map_sky_light(uint texel, uint texels, light_map_sources sources)
{
    vec4 light[3];
    vec4 sky = light_map_texel_part(texel, texels, TEXEL_SKY_LIGHT);
    vec3 radiance = light_map_sky_radiance(texel, texels, sources);
    for (int c = 0; c < 3; c++) light[c] = radiance[c] * sky;
    return light;
}

// Both together.
vec4[3] light_map_area_light(uint texel, uint texels, light_map_sources sources)
{
    vec4 light[3] = light_map_emitted_light(texel, texels, sources);
    vec4 sky[3] = light_map_sky_light(texel, texels, sources);
    for (int c = 0; c < 3; c++) light[c] += sky[c];
    return light;
}

// Irradiance of paint, whose vector irradiance is along the normal.
vec3 light_map_painted_light(uint texel, light_map_sources sources)
{
    if (sources.painted == 0u) return vec3(0.0);
    vec3 lux = imageLoad(light_map_paint, light_map_at(texel)).rgb;
    return min(lux * frame.radiance_scale, vec3(HALF_MAX));
}

// Fluence ∫ L dω by colour of what light_map_sky_light gives.
vec3 light_map_sky_fluence(vec4 sky[3], uint texel, uint texels)
{
    float per_irradiance = light_map_texel_part(texel, texels, TEXEL_FLUENCE).w;
    return per_irradiance * vec3(sky[0].x, sky[1].x, sky[2].x);
}

// The same of light_map_sharp_light. Paint is light from everywhere above: twice its irradiance.
vec3 light_map_sharp_fluence(uint texel, uint texels, light_map_sources sources)
{
    return light_map_texel_part(texel, texels, TEXEL_FLUENCE).rgb *
               (sources.emitters * frame.radiance_scale) +
           2.0 * light_map_painted_light(texel, sources);
}

// Light of emissive surfaces and of paint along the normal, as light_map_emitted_light.
vec4[3] light_map_sharp_light(uint texel, uint texels, light_map_sources sources)
{
    vec4 light[3] = light_map_emitted_light(texel, texels, sources);
    vec3 normal = light_map_texel_part(texel, texels, TEXEL_NORMAL).xyz;
    vec3 painted = light_map_painted_light(texel, sources);
    for (int c = 0; c < 3; c++) light[c] += painted[c] * vec4(1.0, normal);
    return light;
}

#endif
