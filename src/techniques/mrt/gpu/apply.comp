// Irradiance of each pixel from the light map (Loos 2015, section 3.6.3, step 7); SPECULAR: also
// the radiance that the specular lobe reflects.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TILES_BINDING      2
#define MRT_BLOCKS_BINDING     3
#define MRT_CELLS_BINDING      4
#define MRT_CANDIDATES_BINDING 5
#define MRT_LIGHT_MAP_BINDING  6
#define MRT_VECTOR_MAP_BINDING 7
#define MRT_BRICKS_BINDING     11
#define MRT_OUTDOORS_BINDING   12
#define MRT_SIGHT_BINDING      13
#include "core/half.glsl"
#include "core/math.glsl"
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#include "techniques/mrt/gpu/locate.glsl"
#include "techniques/mrt/gpu/bricks.glsl"
#include "techniques/mrt/gpu/lobe.glsl"
#include "techniques/mrt/gpu/outdoors.glsl"
#include "techniques/mrt/gpu/light_map.glsl"

layout(local_size_x = MRT_LOCAL_2D, local_size_y = MRT_LOCAL_2D) in;

layout(set = 0, binding = 8) uniform sampler2D depth;
layout(set = 0, binding = 9) uniform sampler2D normal;
layout(set = 0, binding = 10, rgba16f) uniform image2D irradiance;
layout(push_constant, scalar) uniform push_block
{
    mrt_apply_push push;
};
#if SPECULAR
#include "techniques/mrt/gpu/reflected.glsl"
#endif

// Irradiance; stores what the lobe reflects.
vec3 shade(ivec2 pixel, float z)
{
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
#if SPECULAR
    mrt_reflection reflection = reflection_of(pixel, n, frame_to_viewer(position));
    mrt_light light = level_light(position, n, reflection.lobe);
    store_reflected(pixel, reflection, light.radiance);
    return light.irradiance;
#else
    return level_light(position, n, MRT_NO_LOBE).irradiance;
#endif
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    if (pixel.x < push.clutter_columns && imageLoad(irradiance, pixel).a > 0.0) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 result = vec3(0.0);
    if (z > 0.0) result = shade(pixel, z);
#if SPECULAR
    else
        imageStore(specular, pixel, vec4(0.0, 0.0, 0.0, 1.0));
#endif
    imageStore(irradiance, pixel, vec4(min(level.gain * result, vec3(HALF_MAX)), 1.0));
}
