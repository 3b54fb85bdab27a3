// Painted irradiance of some texels into its table.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/table.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_paint_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer light_map_painted_texels
{
    light_map_painted painted_table[]; // each texel once
};
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D light_map_paint; // [texel] lux

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    light_map_painted painted = painted_table[i];
    imageStore(light_map_paint, light_map_at(painted.texel), vec4(painted.lux, 0.0));
}
