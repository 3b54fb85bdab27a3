// The light map: each of its texels shows the light of its owner.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/place.glsl"
#define TEXEL_LIGHT_BINDING 1
#include "techniques/common/light_map/table.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_show_push push;
};
layout(set = 0, binding = 0) uniform usampler2D light_map_owners; // places and their owners
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2DArray light_map;

void main()
{
    if (gl_GlobalInvocationID.x >= push.count) return;
    uint i = push.first + gl_GlobalInvocationID.x;
    uvec2 owner = texelFetch(light_map_owners, light_map_at(i), 0).xy;
    uvec3 at = light_map_place(owner.x);
    for (uint c = 0; c < push.layers; c++)
        imageStore(light_map, ivec3(at.xy, push.layers * at.z + c),
                   texel_light_of(owner.y, push.texels, int(c)));
}
