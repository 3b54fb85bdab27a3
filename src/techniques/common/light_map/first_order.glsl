// First-order irradiance of texels: all lights with shadows, emissive surfaces, the sky and paint.
// Define LIGHT_MAP_LIGHTS_BINDING and the numbers of texels.glsl and shadow.glsl first.
#ifndef AG_LIGHT_MAP_FIRST_ORDER_GLSL
#define AG_LIGHT_MAP_FIRST_ORDER_GLSL

#include "frame/frame.glsl"
#include "frame/light.glsl"
#include "frame/shadow/shadow.glsl"
#include "techniques/common/light_map/texels.glsl"
#include "techniques/common/texel_light.glsl"

layout(set = 0, binding = LIGHT_MAP_LIGHTS_BINDING, scalar) readonly buffer frame_lights
{
    frame_light frame_light_table[];
};

struct light_map_texel {
    vec4 place;       // world, m; w: area, m²; 0: the texel is inside geometry
    vec3 normal;      // unit, of its side
    vec3 shading;     // mean shading normal, of length 1 or less
    vec3 reflectance; // by colour
};

light_map_texel light_map_texel_of(uint i, uint texels)
{
    return light_map_texel(light_map_texel_part(i, texels, TEXEL_POSITION),
                           light_map_texel_part(i, texels, TEXEL_NORMAL).xyz,
                           light_map_texel_part(i, texels, TEXEL_SHADING).xyz,
                           light_map_texel_part(i, texels, TEXEL_REFLECTANCE).rgb);
}

// Irradiance of light of all directions, as pixels show it: E(n) = (E + n·V)/2 has the mean
// (E + s·V)/2 over shading normals n of mean s. The vector irradiance V of paint is along the
// normal.
vec3 light_map_first_order_of_all(light_map_texel texel, uint i, uint texels,
                                  light_map_sources sources)
{
    vec3 irradiance =
        light_map_painted_light(i, sources) * (0.5 + 0.5 * dot(texel.shading, texel.normal));
    vec4 light[3] = light_map_area_light(i, texels, sources);
    for (int c = 0; c < 3; c++)
        irradiance[c] += max(0.5 * (light[c].x + dot(texel.shading, light[c].yzw)), 0.0);
    return irradiance;
}

// Irradiance of texel i in the units of the frame; 0 where the texel is inside geometry. Shading
// normals receive it, as at pixels.
// shadow_radius: texels of the shadow map.
vec3 light_map_first_order(light_map_texel texel, uint i, uint texels, light_map_sources sources,
                           int shadow_radius)
{
    if (texel.place.w <= 0.0) return vec3(0.0);
    vec3 irradiance = light_map_first_order_of_all(texel, i, texels, sources);
    float cosine = length(texel.shading); // mean of the shading normals to their mean's direction
    vec3 shading = cosine > 0.0 ? texel.shading / cosine : texel.normal;
    for (uint k = 0; k < frame.light_count; k++)
        irradiance += cosine * texel_irradiance(texel.place.xyz, texel.normal, shading,
                                                texel.place.w, frame_light_table[k], shadow_radius);
    return irradiance;
}

#endif
