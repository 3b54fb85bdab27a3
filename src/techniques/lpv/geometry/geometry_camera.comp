// Surfels of the camera (Martin 2012, sec. 3.2.2): every pixel of the G-buffer. One invocation
// takes a block of LPV_TEXELS² pixels.
//
// Area of a surfel: a pixel's rectangle on the plane of its depth has the area |u × v| (m²). Its
// perpendicular area is smaller by the cosine to the camera's axis, the surface behind it larger by
// the cosine between its normal and the direction to the camera.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#define LPV_SURFELS_BINDING 4
#include "techniques/lpv/geometry/geometry_surfels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;

void add(inout lpv_surfel_run run, ivec2 pixel)
{
    float z = texelFetch(depth, pixel, 0).r;
    if (z == 0.0) return;
    vec2 uv = frame_uv(uvec2(pixel)), half_pixel = 0.5 / vec2(lpv.width, lpv.height);
    vec3 position = frame_world_position(uv, z);
    vec3 u = frame_world_position(uv + vec2(half_pixel.x, 0.0), z) -
             frame_world_position(uv - vec2(half_pixel.x, 0.0), z);
    vec3 v = frame_world_position(uv + vec2(0.0, half_pixel.y), z) -
             frame_world_position(uv - vec2(0.0, half_pixel.y), z);
    vec3 offset = frame_to_viewer(position);
    vec3 to_viewer = offset * inversesqrt(max(dot(offset, offset), 1e-20));
    float across = abs(dot(cross(u, v), to_viewer)); // |u × v| cos θ
    lpv_surfel_run_add(
        run, lpv_corner(position),
        lpv_surfel(octahedral_decode(texelFetch(normal, pixel, 0).rg), to_viewer, across));
}

void main()
{
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * LPV_TEXELS;
    ivec2 last = min(first + LPV_TEXELS, ivec2(lpv.width, lpv.height));
    lpv_surfel_run run = lpv_surfel_run(LPV_NO_CORNER, vec4(0.0));
    for (int y = first.y; y < last.y; y++)
        for (int x = first.x; x < last.x; x++) add(run, ivec2(x, y));
    lpv_surfel_run_flush(run);
}
