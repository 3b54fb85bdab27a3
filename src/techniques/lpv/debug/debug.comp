// Debug views: slices of the grid as tiles, z = 0 at the top left, +y up; or surfaces coloured by
// cell.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#define LPV_GEOMETRY_BINDING 6
#include "techniques/lpv/geometry/geometry.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    lpv_view_push push;
};
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler3D volume;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D debug_image;

// Flux of a cell, ∫ I dω = c0 √(4π), as the mean radiance in it.
vec3 mean_radiance(ivec3 cell)
{
    return clamp(texelFetch(volume, cell, 0).rgb / SH_Y0 * push.radiance_scale, 0.0, HALF_MAX);
}

// Occlusion at a cell's faces towards −x, −y, −z, the greater of both directions.
vec3 occlusion(ivec3 cell)
{
    vec3 occluded = vec3(0.0);
    for (int axis = 0; axis < 3; axis++) {
        ivec3 low = ivec3(0);
        low[axis] = -1;
        if (lpv_inside(cell + low))
            occluded[axis] =
                1.0 - min(lpv_transmittance_of(cell, low), lpv_transmittance_of(cell + low, -low));
    }
    return occluded;
}

vec3 slices(ivec2 pixel)
{
    ivec3 cells = lpv_cells();
    int columns = int(ceil(sqrt(float(cells.z))));
    int rows = (cells.z + columns - 1) / columns;
    vec2 tiled = (vec2(pixel) + 0.5) / vec2(lpv.width, lpv.height) * vec2(columns, rows);
    ivec2 tile = ivec2(tiled);
    vec2 within = fract(tiled);
    int z = tile.y * columns + tile.x;
    if (z >= cells.z) return vec3(0.0);
    ivec3 cell = ivec3(ivec2(vec2(within.x, 1.0 - within.y) * 0.9999 * vec2(cells.xy)), z);
    return push.view == LPV_VIEW_GEOMETRY ? occlusion(cell) : mean_radiance(cell);
}

// A colour for the cell that a surface injects into, half a cell along its normal: bright with
// light, dim without.
vec3 cells_on_surfaces(ivec2 pixel)
{
    float z = texelFetch(depth, pixel, 0).r;
    if (z == 0.0) return vec3(0.0);
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 at =
        lpv_cells_from_world(position) + 0.5 * octahedral_decode(texelFetch(normal, pixel, 0).rg);
    ivec3 cell = clamp(ivec3(floor(at)), ivec3(0), lpv_cells() - 1);
    vec3 colour = 0.25 + 0.5 * vec3(cell & 1);
    return colour * (any(greaterThan(mean_radiance(cell), vec3(0.0))) ? 1.0 : 0.1);
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(lpv.width, lpv.height)))) return;
    vec3 colour = push.view == LPV_VIEW_CELLS ? cells_on_surfaces(pixel) : slices(pixel);
    imageStore(debug_image, pixel, vec4(colour, 1.0));
}
