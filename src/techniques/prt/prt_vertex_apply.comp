// Irradiance of each pixel by the light of its triangle's vertices; SPECULAR: also the radiance
// that the specular lobe reflects. Alpha is 0 where there is no such triangle. Pixels without a
// surface stay as they are.
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
#include "techniques/common/light_map/lookup.glsl"
#include "techniques/common/light_map/surface.glsl"
#include "techniques/common/light_map/table.glsl"
#include "techniques/prt/prt_vertex.glsl"

layout(constant_id = LIGHT_MAP_APPLY_DIELECTRIC) const bool HAS_DIELECTRIC = false;

layout(push_constant, scalar) uniform push_block
{
    prt_vertex_push push_of_all;
};
prt_vertex_push push; // a copy, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
#include "techniques/common/light_map/columns.glsl"
layout(set = 0, binding = 6, rgba32ui) uniform readonly uimage2D prt_corners;   // [side][triangle]
layout(set = 0, binding = 14, rgba32ui) uniform readonly uimage2D vertex_light; // [part][vertex]
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D irradiance;
#if SPECULAR
layout(set = 0, binding = 9) uniform sampler2D albedo;
layout(set = 0, binding = 10) uniform sampler2D material;
layout(set = 0, binding = 11) uniform sampler2D dielectric; // FRAME_DIELECTRIC if HAS_DIELECTRIC
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"
#endif

// One division, where normalize has three on software drivers.
vec3 unit(vec3 v)
{
    return v * inversesqrt(max(dot(v, v), 1e-20));
}

// Weights of the corners, moved into the triangle.
vec3 corner_weights(vec2 place)
{
    vec2 at = max(place, vec2(0.0));
    at /= max(at.x + at.y, 1.0);
    return vec3(1.0 - at.x - at.y, at);
}

// The vector irradiance is along the interpolated normal, where E(n) = (E + n·V) / 2 is E.
light_map_light light_of(uint triangle, vec3 place, vec3 n)
{
    uint row = triangle + uint(place.z) * push.triangles;
    uvec3 corner = imageLoad(prt_corners, light_map_at(row)).xyz;
    vec3 weight = corner_weights(place.xy);
    prt_vertex_light sum = prt_vertex_dark();
    for (int k = 0; k < 3; k++) {
        prt_vertex_add_0(sum, weight[k], imageLoad(vertex_light, light_map_at(corner[k])));
        if (EMITTED)
            prt_vertex_add_1(sum, weight[k],
                             imageLoad(vertex_light, light_map_at(push.vertices + corner[k])));
    }
    light_map_light light;
    light.vector = outerProduct(unit(sum.normal), sum.irradiance) + sum.beside;
    light.irradiance = clamp(0.5 * (sum.irradiance + n * light.vector), vec3(0.0), vec3(HALF_MAX));
    return light;
}

#if SPECULAR
vec3 reflected(ivec2 pixel, light_map_surface s, light_map_light light)
{
    brdf_material m = pixel_material(pixel, HAS_DIELECTRIC);
    vec3 n = s.normal, to_viewer = unit(s.to_viewer);
    vec3 radiance = light_map_radiance(light, n, to_viewer, brdf_alpha(m.roughness));
    return pixel_reflected(m, n, to_viewer, radiance);
}
#endif

void shade(ivec2 pixel)
{
    float z = texelFetch(depth, pixel, 0).r;
    light_map_light light = light_map_light(vec3(0.0), mat3(0.0));
    vec2 uv = (vec2(pixel) + 0.5) * vec2(push.per_view_width, push.per_view_height);
    vec3 position = frame_ray_origin(uv) + frame_view_distance(z) * frame_view_ray(uv);
    vec3 n = unit(octahedral_direction(texelFetch(normal, pixel, 0).rg));
    light_map_surface s = light_map_surface(position, n, frame_to_viewer(position));
    uvec2 ids = texelFetch(id, pixel, 0).rg;
    uint triangle = light_map_scene_triangle(ids, push.instances);
    vec3 place = light_map_place_in(triangle, ids, push.instances, s);
    bool in_map = place.z >= 0.0;
    if (in_map) light = light_of(triangle, place, s.normal);
    imageStore(irradiance, pixel, vec4(light.irradiance, in_map ? 1.0 : 0.0));
#if SPECULAR
    imageStore(specular, pixel, vec4(reflected(pixel, s, light), 1.0));
#endif
}

void main()
{
    frame = frame_block;
    push = push_of_all;
    shade_column(ivec2(frame.width, frame.height));
}
