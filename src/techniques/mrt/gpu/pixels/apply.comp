// Irradiance of each pixel from the light map (Loos 2015, section 3.6.3, step 7); SPECULAR: also
// the radiance that the specular lobe reflects. In a level of affine cubes, of pixels that one
// lookup of a wall lights; listed.comp lights the others, which are in lists. The host has cleared
// pixels without a surface.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/gpu/pixels/pixel.glsl"

layout(push_constant, scalar) uniform push_block
{
    mrt_apply_push push_of_all;
};
mrt_apply_push push; // a copy, as FRAME_CONSTANTS_COPIED
#include "techniques/common/light_map/columns.glsl"

layout(set = 0, binding = 21, scalar) buffer amid_list
{
    mrt_list_header amid;
    uint amid_pixels[]; // y << 16 | x
};
layout(set = 0, binding = 22, scalar) buffer several_list
{
    mrt_list_header several;
    uint several_pixels[];
};

void append_amid(ivec2 pixel)
{
    uint to = atomicAdd(amid.count, 1u);
    if (to % MRT_LOCAL == 0u) atomicAdd(amid.groups[0], 1u);
    amid_pixels[to] = uint(pixel.y) << 16 | uint(pixel.x);
}

void append_several(ivec2 pixel)
{
    uint to = atomicAdd(several.count, 1u);
    if (to % MRT_LOCAL == 0u) atomicAdd(several.groups[0], 1u);
    several_pixels[to] = uint(pixel.y) << 16 | uint(pixel.x);
}

void shade(ivec2 pixel)
{
    // Clutter has light.
    if (pixel.x < push.clutter_columns && imageLoad(irradiance, pixel).a > 0.0) return;
    pixel_surface s = surface_of(pixel);
    if (!AFFINE || TUBES) {
        store_light(s, level_light(s.position, s.normal, s.lobe));
        return;
    }
    mrt_light light;
    int kind = plain_light(s.position, s.normal, s.lobe, light);
    if (kind == MRT_OF_WALL) store_light(s, light);
    if (kind == MRT_OF_PROBES) append_amid(pixel);
    if (kind == MRT_OF_SEVERAL) append_several(pixel);
}

void main()
{
    frame = frame_block;
    level = level_block;
    push = push_of_all;
    shade_column(ivec2(frame.width, frame.height));
}
