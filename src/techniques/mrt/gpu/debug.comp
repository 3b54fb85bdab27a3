// Debug views. blocks: the block map over the scene, a colour for each block, squares for texels,
// lines at the edges of its cell; as bright as a grey surface there, which suits any exposure.
// direct: radiosity of the texels, without interpolation.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TILES_BINDING      2
#define MRT_BLOCKS_BINDING     3
#define MRT_CELLS_BINDING      4
#define MRT_CANDIDATES_BINDING 5
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/mrt/gpu/locate.glsl"
#include "techniques/mrt/gpu/tube.glsl"

layout(local_size_x = MRT_LOCAL_2D, local_size_y = MRT_LOCAL_2D) in;

layout(push_constant, scalar) uniform push_block
{
    mrt_view_push push;
};
layout(set = 0, binding = 6, scalar) readonly buffer mrt_direct
{
    vec3 direct_table[];
};
layout(set = 0, binding = 8) uniform sampler2D depth;
layout(set = 0, binding = 9) uniform sampler2D normal;
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D debug_image;
layout(set = 0, binding = 11) uniform sampler2D scene; // radiance of direct light
layout(set = 0, binding = 12) uniform sampler2D irradiance;

const float EDGE = 0.01; // width of lines, edges of the cell

// Colours that differ between neighbouring numbers.
vec3 colour_of(int block)
{
    vec3 phase = fract(float(block) * 0.61803399 + vec3(0.0, 1.0 / 3.0, 2.0 / 3.0));
    return 0.5 + 0.5 * cos(2.0 * PI * phase);
}

// The wall that faces the surface's way most; −1: all of those are openings.
int facing_wall(mrt_place place, vec3 n)
{
    int best = -1;
    float most = 0.0;
    for (int f = 0; f < 6; f++) {
        float cosine = (f & 1) != 0 ? -n[f / 2] : n[f / 2];
        if (cosine <= most || block_table[place.block].tile[f] < 0) continue;
        most = cosine;
        best = f;
    }
    return best;
}

// Radiance of the surface, with the indirect light that a grey one reflects.
float brightness(ivec2 pixel)
{
    vec3 light =
        texelFetch(scene, pixel, 0).rgb + texelFetch(irradiance, pixel, 0).rgb * (0.5 / PI);
    return dot(light, vec3(0.2126, 0.7152, 0.0722));
}

vec2 place_on_wall(mrt_place place, int face)
{
    if (TUBES) {
        mrt_tube_place at = tube_place(place.block, place.cell);
        return vec2(at.around, at.along);
    }
    mat3 frame_of_face = cube_from_face(face);
    return 0.5 + vec2(dot(frame_of_face[0], place.cell), dot(frame_of_face[1], place.cell));
}

vec3 shade(ivec2 pixel, float z)
{
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    vec3 world = frame_world_position(frame_uv(uvec2(pixel)), z);
    mrt_place place = locate(world + level.offset_m * n);
    vec3 unmapped = vec3(0.25 * brightness(pixel));
    if (place.block < 0) return unmapped;
    int face = TUBES ? 0 : facing_wall(place, normal_in_cell(place, n));
    if (face < 0) return unmapped;
    vec2 st = clamp(place_on_wall(place, face), 0.0, 0.9999);
    ivec2 texel = ivec2(st * float(level.resolution));
    if (push.view == MRT_VIEW_DIRECT)
        return direct_table[tile_table[block_table[place.block].tile[face]].first_texel +
                            uint(texel.y) * level.resolution + uint(texel.x)] /
               PI;
    vec2 to_edge = min(st, 1.0 - st);
    float bright = min(to_edge.x, to_edge.y) < EDGE ? 2.0
                   : ((texel.x ^ texel.y) & 1) != 0 ? 0.8
                                                    : 1.0;
    return bright * brightness(pixel) * (0.2 + colour_of(place.block));
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 colour = z > 0.0 ? shade(pixel, z) : vec3(0.0);
    imageStore(debug_image, pixel, vec4(min(colour, vec3(HALF_MAX)), 1.0));
}
