// First-order irradiance of texels: all lights with shadows, emissive surfaces, the sky and paint.
// Define LIGHT_MAP_LIGHTS_BINDING, LIGHT_MAP_TEXELS_BINDING, LIGHT_MAP_PAINT_BINDING and those of
// shadow.glsl first.
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
    vec4 reflectance; // by colour; w: mean cosine between shading normals and the normal
};

light_map_texel light_map_texel_of(uint i, uint texels)
{
    return light_map_texel(light_map_texel_part(i, texels, TEXEL_POSITION),
                           light_map_texel_part(i, texels, TEXEL_NORMAL).xyz,
                           light_map_texel_part(i, texels, TEXEL_REFLECTANCE));
}

// Irradiance of texel i in the units of the frame; 0 where the texel is inside geometry.
// shadow_radius: texels of the shadow map.
vec3 light_map_first_order(light_map_texel texel, uint i, uint texels, light_map_sources sources,
                           int shadow_radius)
{
    vec3 irradiance = vec3(0.0);
    if (texel.place.w > 0.0) {
        for (int c = 0; c < 3; c++) irradiance[c] = light_map_unbounced(i, texels, c, sources).x;
        irradiance += light_map_painted_light(i, sources);
        // Shading normals n of mean cosine c to the surface's receive c of the light of a
        // direction, and E(n) = (E + n·V)/2 of light of all: (1 + c)/2.
        irradiance *= 0.5 + 0.5 * texel.reflectance.w;
        for (uint k = 0; k < frame.light_count; k++)
            irradiance +=
                texel.reflectance.w * texel_irradiance(texel.place.xyz, texel.normal, texel.place.w,
                                                       frame_light_table[k], shadow_radius);
    }
    return irradiance;
}

#endif
