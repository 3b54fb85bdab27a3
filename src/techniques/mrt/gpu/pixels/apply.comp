// Irradiance of each pixel from the light map (Loos 2015, section 3.6.3, step 7); SPECULAR: also
// the radiance that the specular lobe reflects. In a level of affine cubes, of pixels that one
// lookup of a wall lights; listed.comp lights the others, which are in lists; CLUTTER: and those
// of clutter. The host has cleared pixels without a surface.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/mrt/gpu/pixels/pixel.glsl"
#if CLUTTER
#include "techniques/mrt/gpu/pixels/clutter.glsl"
#endif
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

#if CLUTTER
layout(set = 0, binding = 23, scalar) buffer clutter_list
{
    mrt_list_header clutter;
    uint clutter_pixels[];
};
#endif

// Adds a pixel to a list. A macro, as functions take no buffers.
#define APPEND(list, pixels, pixel)                                                                \
    {                                                                                              \
        uint to = atomicAdd(list.count, 1u);                                                       \
        if (to % MRT_LOCAL == 0u) atomicAdd(list.groups[0], 1u);                                   \
        pixels[to] = uint(pixel.y) << 16 | uint(pixel.x);                                          \
    }

void shade(ivec2 pixel)
{
#if CLUTTER
    if (is_of_clutter(pixel)) {
        APPEND(clutter, clutter_pixels, pixel);
        return;
    }
#endif
    pixel_surface s = surface_of(pixel);
    if (!AFFINE || TUBES) {
        store_light(s, level_light(s.position, s.normal, s.lobe));
        return;
    }
    mrt_light light;
    int kind = plain_light(s.position, s.normal, s.lobe, light);
    if (kind == MRT_OF_WALL) store_light(s, light);
    if (kind == MRT_OF_PROBES) APPEND(amid, amid_pixels, pixel);
    if (kind == MRT_OF_SEVERAL) APPEND(several, several_pixels, pixel);
}

void main()
{
    frame = frame_block;
    level = level_block;
    shade_column(ivec2(frame.width, frame.height));
}
