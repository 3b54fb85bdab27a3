// Replaces entries of a table.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/light_map/table.glsl"

layout(local_size_x = LIGHT_MAP_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    light_map_rows_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer light_map_new_rows
{
    vec4 row_table[];
};
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D light_map_table;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    imageStore(light_map_table, light_map_at(push.first + i), row_table[i]);
}
