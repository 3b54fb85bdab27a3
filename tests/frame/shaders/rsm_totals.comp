#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Writes rsm_fetch of every texel of a reflective shadow map: validity, flux, position, normal.
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer rsm_faces
{
    rsm_face rsm_face_table[];
};
layout(set = 0, binding = 2) uniform sampler2DArray rsm_depth;
layout(set = 0, binding = 3) uniform sampler2DArray rsm_normal;
layout(set = 0, binding = 4) uniform sampler2DArray rsm_flux;
layout(set = 0, binding = 5, scalar) writeonly buffer texels
{
    float texel[];
};

layout(push_constant) uniform push_block
{
    uint size;
}
push;

void main()
{
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (at.x >= int(push.size) || at.y >= int(push.size)) return;
    rsm_texel t =
        rsm_fetch(rsm_face_table[at.z], at.xy, at.z, push.size, rsm_depth, rsm_normal, rsm_flux);
    uint o = ((at.z * push.size + at.y) * push.size + at.x) * 10;
    texel[o] = t.valid ? 1.0 : 0.0;
    for (int k = 0; k < 3; k++) {
        texel[o + 1 + k] = t.flux[k];
        texel[o + 4 + k] = t.position[k];
        texel[o + 7 + k] = t.normal[k];
    }
}
