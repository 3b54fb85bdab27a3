// A pixel's surface and its light. SPECULAR: also what its specular lobe reflects.
#ifndef AG_MRT_PIXEL_GLSL
#define AG_MRT_PIXEL_GLSL

#define FRAME_CONSTANTS_COPIED
#define MRT_LEVEL_COPIED
#define MRT_BLOCKS_BINDING     3
#define MRT_CELLS_BINDING      4
#define MRT_CANDIDATES_BINDING 5
#define MRT_LIGHT_MAP_BINDING  6
#define MRT_BRICKS_BINDING     11
#define MRT_OUTDOORS_BINDING   12
#define MRT_SIGHT_BINDING      13
#define MRT_BLOCK_ROWS_BINDING 19
#define MRT_CELL_ROWS_BINDING  20
#include "core/half.glsl"
#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#include "techniques/mrt/gpu/locate.glsl"
#include "techniques/mrt/gpu/bricks.glsl"
#include "techniques/mrt/gpu/pixels/lobe.glsl"
#include "techniques/mrt/gpu/pixels/outdoors.glsl"
#include "techniques/mrt/gpu/pixels/light_map.glsl"
#include "techniques/mrt/gpu/pixels/rows.glsl"

layout(set = 0, binding = 8) uniform sampler2D depth;
layout(set = 0, binding = 9) uniform sampler2D normal;
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D irradiance;
#if SPECULAR
#include "techniques/mrt/gpu/pixels/reflected.glsl"
#endif

// A surface of a pixel, and its light.
struct pixel_surface {
    ivec2 at;
    vec3 position, normal;
#if SPECULAR
    mrt_reflection reflection;
#endif
    mrt_lobe lobe;
};

pixel_surface surface_of(ivec2 at)
{
    pixel_surface s;
    s.at = at;
    vec2 uv = frame_uv(uvec2(at));
    float distance = frame_view_distance(texelFetch(depth, at, 0).r);
    s.position = frame_ray_origin(uv) + distance * frame_view_ray(uv);
    s.normal = octahedral_decode(texelFetch(normal, at, 0).rg);
    s.lobe = MRT_NO_LOBE;
#if SPECULAR
    s.reflection = reflection_of(at, s.normal, frame_to_viewer(s.position));
    s.lobe = s.reflection.lobe;
#endif
    return s;
}

void store_light(pixel_surface s, mrt_light light)
{
    imageStore(irradiance, s.at, vec4(min(level.gain * light.irradiance, vec3(HALF_MAX)), 1.0));
#if SPECULAR
    store_reflected(s.at, s.reflection, light.radiance);
#endif
}

#endif
