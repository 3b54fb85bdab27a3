// Debug views: charts, clusters and valid texels of the light map, on its surfaces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#define LIGHT_MAP_INSTANCES_BINDING 4
#define LIGHT_MAP_TRIANGLES_BINDING 5
#define LIGHT_MAP_MOVES_BINDING     9
#include "techniques/common/light_map/surface.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL_2D, local_size_y = RADIOSITY_LOCAL_2D) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_view_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
layout(set = 0, binding = 7, scalar) readonly buffer radiosity_labels
{
    radiosity_gpu_label label_table[]; // [side][y][x]
};
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D target;

const vec3 NONE = vec3(0.02); // no light map
// Colours of RADIOSITY_SAMPLED_IN_MIDDLE and the states after it.
const vec3 VALIDITY[4] =
    vec3[](vec3(0.2), vec3(0.6, 0.45, 0.05), vec3(0.5, 0.0, 0.5), vec3(0.7, 0.05, 0.05));

// Integers of neighbours have colours far apart: the finalizer of MurmurHash3.
vec3 colour_of(uint number)
{
    uint h = (number ^ number >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    h ^= h >> 16;
    return 0.08 + 0.6 * vec3(uvec3(h, h >> 8, h >> 16) & 0xffu) / 255.0;
}

vec3 colour_at(vec3 at)
{
    // Rounding at an edge of a triangle may leave the texels of its chart, not its gutter.
    uvec2 texel = uvec2(clamp(at.xy, vec2(0.0), vec2(push.width, push.height) - 1.0));
    uint place = (uint(at.z) * push.height + texel.y) * push.width + texel.x;
    radiosity_gpu_label label = label_table[place];
    if (label.state == uint(RADIOSITY_NO_TEXEL)) return NONE;
    if (push.view == uint(RADIOSITY_VIEW_CHARTS)) return colour_of(label.chart);
    if (push.view == uint(RADIOSITY_VIEW_CLUSTERS)) return colour_of(label.cluster);
    return VALIDITY[label.state];
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 colour = vec3(0.0);
    if (z > 0.0) {
        vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        light_map_surface s = light_map_surface(position, n, frame_to_viewer(position));
        vec3 at = light_map_place_of(texelFetch(id, pixel, 0).rg, push.instances, s);
        float facing = abs(dot(n, normalize(frame_to_viewer(position))));
        colour = (at.z < 0.0 ? NONE : colour_at(at)) * (0.5 + 0.5 * facing);
    }
    imageStore(target, pixel, vec4(colour, 1.0));
}
