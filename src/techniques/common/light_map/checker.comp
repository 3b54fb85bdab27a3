// Debug view: a checkerboard of the texels of a light map, on its surfaces.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#define LIGHT_MAP_INSTANCES_BINDING 4
#define LIGHT_MAP_TRIANGLES_BINDING 5
#define LIGHT_MAP_MOVES_BINDING     6
#include "techniques/common/light_map/map_shared.h"
#include "techniques/common/light_map/surface.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL_2D, local_size_y = LIGHT_MAP_LOCAL_2D) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_checker_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform usampler2D id; // FRAME_ID
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D target;

// `at`: a place of the light map; z is negative where there is none.
float brightness_at(vec3 at)
{
    uvec2 texel = uvec2(max(at.xy, vec2(0.0)));
    return at.z < 0.0 ? 0.02 : (texel.x + texel.y & 1u) == 0u ? 0.5 : 0.15;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r, brightness = 0.0;
    if (z > 0.0) {
        vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        float facing = abs(dot(n, normalize(frame_to_viewer(position))));
        light_map_surface s = light_map_surface(position, n, frame_to_viewer(position));
        vec3 at = light_map_place_of(texelFetch(id, pixel, 0).rg, push.instances, s);
        brightness = brightness_at(at) * (0.5 + 0.5 * facing);
    }
    imageStore(target, pixel, vec4(vec3(brightness), 1.0));
}
