// The light map: each of its texels shows the light of its owner.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "techniques/radiosity/radiosity_shared.h"

layout(local_size_x = RADIOSITY_LOCAL_2D, local_size_y = RADIOSITY_LOCAL_2D) in;

layout(push_constant, scalar) uniform push_block
{
    radiosity_map_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer radiosity_owners
{
    uint owner_table[]; // [side][y][x]; all bits set: none
};
layout(set = 0, binding = 1, scalar) readonly buffer radiosity_light
{
    vec4 light_table[];
};
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2DArray light_map;

void main()
{
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= push.width || at.y >= push.height) return;
    uint owner = owner_table[(at.z * push.height + at.y) * push.width + at.x];
    if (owner == 0xffffffffu) return;
    for (int c = 0; c < 3; c++)
        imageStore(light_map, ivec3(at.xy, RADIOSITY_LAYERS * at.z + c),
                   clamp(light_table[3u * owner + c], -HALF_MAX, HALF_MAX));
}
