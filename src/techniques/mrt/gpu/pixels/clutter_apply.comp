// Irradiance of the pixels of clutter from its light map, found by the triangle that they show;
// SPECULAR: also the radiance that the specular lobe reflects.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#define LIGHT_MAP_INSTANCES_BINDING 2
#define LIGHT_MAP_TRIANGLES_BINDING 3
#define LIGHT_MAP_MOVES_BINDING     4
#include "techniques/common/light_map/surface.glsl"
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/pixels/lobe.glsl"

layout(local_size_x = MRT_LOCAL_2D, local_size_y = MRT_LOCAL_2D) in;

layout(set = 0, binding = 5) uniform sampler2DArray clutter_map;
layout(set = 0, binding = 6) uniform usampler2D id;
layout(set = 0, binding = 7) uniform sampler2D depth;
layout(set = 0, binding = 8) uniform sampler2D normal;
layout(push_constant, scalar) uniform push_block
{
    light_map_instances push;
};
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D irradiance;

#if SPECULAR
#include "techniques/mrt/gpu/pixels/reflected.glsl"
#endif

// The vector irradiance is that along the surface.
light_map_light map_light(vec3 place, vec3 n)
{
    vec2 uv = place.xy / vec2(textureSize(clutter_map, 0).xy);
    light_map_light light;
    for (int c = 0; c < 3; c++) {
        float layer = float(LIGHT_MAP_LAYERS) * place.z + float(c);
        vec4 texel = textureLod(clutter_map, vec3(uv, layer), 0.0);
        light.irradiance[c] = max(sh4_dot(texel, n), 0.0);
        light.vector[c] = vector_of_fit(texel);
    }
    return light;
}

// Whether the map lights the pixel. One that was added since the map was made has the light of
// probes.
bool find_light(ivec2 pixel, out vec3 irradiance)
{
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    float z = texelFetch(depth, pixel, 0).r;
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    light_map_surface s = light_map_surface(position, n, frame_to_viewer(position));
    vec3 place = light_map_place_of(texelFetch(id, pixel, 0).rg, push, s);
    irradiance = vec3(0.0);
    if (place.z < 0.0) return false;
    light_map_light light = map_light(place, s.normal);
    irradiance = level.gain * light.irradiance;
#if SPECULAR
    mrt_reflection reflection = reflection_of(pixel, s.normal, s.to_viewer);
    store_reflected(pixel, reflection,
                    light_map_radiance_of(light, s.normal, reflection.lobe.surface));
#endif
    return true;
}

// Alpha is 0 where apply.comp has to find the light of a surface.
void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec3 light = vec3(0.0);
    bool found = find_light(pixel, light);
    bool done = found || texelFetch(depth, pixel, 0).r <= 0.0;
    imageStore(irradiance, pixel, vec4(min(light, vec3(HALF_MAX)), done ? 1.0 : 0.0));
}
