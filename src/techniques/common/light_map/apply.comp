// Irradiance of each pixel from the light map; SPECULAR: also the radiance that the specular lobe
// reflects, REFLECTED: as texels reflect it. Alpha is 0 where the map has no light.
// Pixels without a surface stay as they are.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#if SPECULAR
#define GGX_ALBEDO_BINDING 8
#endif
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/octahedral.glsl"
#define LIGHT_MAP_INSTANCES_BINDING 4
#define LIGHT_MAP_TRIANGLES_BINDING 5
#define LIGHT_MAP_MOVES_BINDING     13
#include "core/half.glsl"
#include "techniques/common/light_map/lookup.glsl"
#include "techniques/common/light_map/surface.glsl"
#define LIGHT_MAP_WALLS_BINDING 17
#include "techniques/common/light_map/walls.glsl"
#if SPECULAR && !REFLECTED
layout(constant_id = LIGHT_MAP_APPLY_MIRRORS) const bool MIRRORS = false;
#define ENVIRONMENT_MAP_BINDING       14
#define ENVIRONMENT_HAS_MAP           MIRRORS
#define LIGHT_MAP_VISIBLE_SKY_BINDING 15
#include "frame/environment_map.glsl"
#include "techniques/common/light_map/mirror.glsl"
#endif

layout(constant_id = LIGHT_MAP_APPLY_DIELECTRIC) const bool HAS_DIELECTRIC = false;

layout(push_constant, scalar) uniform push_block
{
    light_map_apply_push push_of_all;
};
light_map_apply_push push; // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
#include "techniques/common/light_map/columns.glsl"
layout(set = 0, binding = 6) uniform sampler2DArray light_map;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D irradiance;
#if SPECULAR
layout(set = 0, binding = 9) uniform sampler2D albedo;
layout(set = 0, binding = 10) uniform sampler2D material;
layout(set = 0, binding = 11) uniform sampler2D dielectric; // FRAME_DIELECTRIC if HAS_DIELECTRIC
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"
#endif
#if REFLECTED
layout(set = 0, binding = 16) uniform sampler2DArray reflected_map;
#elif FLUENCE
layout(set = 0, binding = 18) uniform sampler2DArray fluence_map;
#endif

// One division, where normalize has three on software drivers.
vec3 unit(vec3 v)
{
    return v * inversesqrt(dot(v, v));
}

#if SPECULAR
// place: in texels; z: the side, or negative.
vec3 reflected(ivec2 pixel, light_map_surface s, light_map_light light, vec3 place)
{
    brdf_material m = pixel_material(pixel, HAS_DIELECTRIC);
    vec3 n = s.normal, to_viewer = unit(s.to_viewer);
#if REFLECTED
    vec2 uv = place.xy * vec2(push.per_width, push.per_height);
    vec3 radiance =
        place.z < 0.0 ? vec3(0.0) : textureLod(reflected_map, vec3(uv, place.z), 0.0).rgb;
#else
    float alpha = brdf_alpha(m.roughness);
    light_map_lobe lobe = light_map_lobe_of(n, to_viewer, alpha);
#if FLUENCE
    vec2 uv = place.xy * vec2(push.per_width, push.per_height);
    vec3 fluence = place.z < 0.0 ? vec3(0.0) : textureLod(fluence_map, vec3(uv, place.z), 0.0).rgb;
    vec3 radiance = light_map_radiance_by_fluence(light, fluence, n, lobe);
#else
    vec3 radiance = light_map_radiance_of(light, n, lobe);
#endif
    if (MIRRORS && place.z >= 0.0) {
        vec3 at = vec3(place.xy * vec2(push.per_width, push.per_height), place.z);
        radiance += light_map_mirrored(at, n, to_viewer, m.roughness);
    }
#endif
    return pixel_reflected(m, n, to_viewer, radiance);
}
#endif

void shade(ivec2 pixel)
{
    vec2 uv = (vec2(pixel) + 0.5) * vec2(push.per_view_width, push.per_view_height);
    float z = texelFetch(depth, pixel, 0).r;
    vec3 position = frame_ray_origin(uv) + frame_view_distance(z) * frame_view_ray(uv);
    vec3 n = unit(octahedral_direction(texelFetch(normal, pixel, 0).rg));
    light_map_surface s = light_map_surface(position, n, frame_to_viewer(position));
    vec3 place = light_map_place_of(texelFetch(id, pixel, 0).rg, push.instances, s);
    vec2 per_size = vec2(push.per_width, push.per_height);
    light_map_light light = light_map_light(vec3(0.0), mat3(0.0));
    bool in_map = place.z >= 0.0;
    place.xy = in_map ? light_map_before_wall(place) : place.xy;
    if (in_map) light = light_map_lookup(light_map, per_size, place, s.normal);
    imageStore(irradiance, pixel, vec4(light.irradiance, in_map ? 1.0 : 0.0));
#if SPECULAR
    imageStore(specular, pixel, vec4(reflected(pixel, s, light, place), 1.0));
#endif
}

void main()
{
    frame = frame_block;
    push = push_of_all;
    shade_column(ivec2(frame.width, frame.height));
}
