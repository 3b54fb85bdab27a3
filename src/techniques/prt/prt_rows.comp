// Light of each row of the codebook, means and vectors of clusters; alpha: of a visible sky of
// radiance 1.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/prt/prt_transfer.glsl"

layout(local_size_x = PRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    prt_rows_push push;
};
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D prt_row_light;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.rows) return;
    imageStore(prt_row_light, light_map_at(i),
               vec4(prt_row_irradiance(i, push.rows), prt_row_sky(i)));
}
