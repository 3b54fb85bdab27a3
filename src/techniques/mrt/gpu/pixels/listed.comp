// Light of the pixels in a list of apply.comp. LIST: SEVERAL, AMID, which probes light, or CLUTTER.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define SEVERAL 0
#define AMID    1
#define CLUTTER 2

#include "techniques/mrt/gpu/pixels/pixel.glsl"
#if LIST == CLUTTER
#define MRT_CLUTTER_MAP_BINDING 22
#include "techniques/mrt/gpu/pixels/clutter.glsl"
#endif

layout(local_size_x = MRT_LOCAL) in;

layout(set = 0, binding = 21, scalar) readonly buffer pixel_list
{
    mrt_list_header list;
    uint list_pixels[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    frame = frame_block;
    level = level_block;
    if (i >= list.count) return;
    uint word = list_pixels[i];
    pixel_surface s = surface_of(ivec2(word & 0xffffu, word >> 16));
#if LIST == CLUTTER
    store_light(s, clutter_light(s));
#elif LIST == AMID
    store_light(s, amid_light(s.position, s.normal, s.lobe));
#else
    store_light(s, level_light(s.position, s.normal, s.lobe));
#endif
}
