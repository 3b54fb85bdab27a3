// Surfels of one light (Martin 2012, sec. 3.2.2): every texel of its reflective shadow maps. One
// invocation takes a block of LPV_TEXELS² texels.
//
// Area of a surfel: the texel of a sun's map is a beam of perpendicular area (2 w / size)², w the
// half-width of the map (m); that of a point or spot light is a cone of solid angle Ω (sr), which
// has the area Ω r² at the distance r (m). The surface is larger by the cosine between its normal
// and the direction to the light.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#define LPV_SURFELS_BINDING 4
#include "techniques/lpv/geometry/geometry_surfels.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    uint first_face;
}
push;
layout(set = 0, binding = 1, scalar) readonly buffer rsm_faces
{
    rsm_face faces[];
};
layout(set = 0, binding = 2) uniform sampler2DArray rsm_depth;
layout(set = 0, binding = 3) uniform sampler2DArray rsm_normal;

void add(inout lpv_surfel_run run, rsm_face face, ivec3 texel)
{
    float depth = texelFetch(rsm_depth, texel, 0).r;
    if (depth == 0.0) return;
    vec3 position = rsm_position(face, texel.xy, lpv.rsm_size, depth);
    vec3 to_light = -face.direction;
    float across = 2.0 * face.tan_half / float(lpv.rsm_size);
    across *= across;
    if (face.type != FRAME_LIGHT_SUN) {
        vec3 offset = face.position - position;
        float distance2 = dot(offset, offset);
        to_light = offset * inversesqrt(max(distance2, 1e-20));
        across = rsm_solid_angle(face, texel.xy, lpv.rsm_size) * distance2;
    }
    vec3 normal = octahedral_decode(texelFetch(rsm_normal, texel, 0).rg);
    lpv_surfel_run_add(run, lpv_corner(position), lpv_surfel(normal, to_light, across));
}

void main()
{
    int layer = int(push.first_face + gl_GlobalInvocationID.z);
    rsm_face face = faces[layer];
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * LPV_TEXELS;
    ivec2 last = min(first + LPV_TEXELS, ivec2(lpv.rsm_size));
    lpv_surfel_run run = lpv_surfel_run(LPV_NO_CORNER, vec4(0.0));
    for (int y = first.y; y < last.y; y++)
        for (int x = first.x; x < last.x; x++) add(run, face, ivec3(x, y, layer));
    lpv_surfel_run_flush(run);
}
