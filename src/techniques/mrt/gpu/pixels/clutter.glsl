// Pixels of clutter, and their light from its light map, found by the triangle that they show.
// Needs pixel.glsl.
#ifndef AG_MRT_CLUTTER_GLSL
#define AG_MRT_CLUTTER_GLSL

#define LIGHT_MAP_INSTANCES_BINDING 24
#define LIGHT_MAP_TRIANGLES_BINDING 25
#define LIGHT_MAP_MOVES_BINDING     26
#include "techniques/common/light_map/surface.glsl"

layout(set = 0, binding = 27) uniform usampler2D id;

bool is_of_clutter(ivec2 pixel)
{
    return light_map_has(texelFetch(id, pixel, 0).rg, level.clutter);
}

#ifdef MRT_CLUTTER_MAP_BINDING
layout(set = 0, binding = MRT_CLUTTER_MAP_BINDING) uniform sampler2DArray clutter_map;

// The vector irradiance is that along the surface.
light_map_light clutter_map_light(vec3 place, vec3 normal)
{
    vec2 uv = place.xy / vec2(textureSize(clutter_map, 0).xy);
    light_map_light light;
    for (int c = 0; c < 3; c++) {
        float layer = float(LIGHT_MAP_LAYERS) * place.z + float(c);
        vec4 texel = textureLod(clutter_map, vec3(uv, layer), 0.0);
        light.irradiance[c] = max(sh4_dot(texel, normal), 0.0);
        light.vector[c] = vector_of_fit(texel);
    }
    return light;
}

mrt_light clutter_light(pixel_surface pixel)
{
    light_map_surface s =
        light_map_surface(pixel.position, pixel.normal, frame_to_viewer(pixel.position));
    vec3 place = light_map_place_of(texelFetch(id, pixel.at, 0).rg, level.clutter, s);
    light_map_light light = clutter_map_light(place, s.normal);
    mrt_light result = mrt_light(light.irradiance, vec3(0.0));
#if SPECULAR
    float alpha = brdf_alpha(pixel.reflection.material.roughness);
    result.radiance = light_map_radiance(light, s.normal, normalize(s.to_viewer), alpha);
#endif
    return result;
}
#endif

#endif
