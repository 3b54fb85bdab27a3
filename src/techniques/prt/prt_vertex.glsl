// Light of vertices (prt_shared.h) and its sums over the corners of a triangle.
#ifndef AG_PRT_VERTEX_GLSL
#define AG_PRT_VERTEX_GLSL

#include "core/half.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = PRT_HAS_EMITTED) const bool EMITTED = true;

struct prt_vertex_light {
    vec3 irradiance, normal;
    mat3 beside; // a column for each colour: vector irradiance beside the normal
};

prt_vertex_light prt_vertex_dark()
{
    return prt_vertex_light(vec3(0.0), vec3(0.0), mat3(0.0));
}

uvec4 prt_vertex_pack_0(prt_vertex_light v)
{
    return uvec4(packHalf2x16(v.irradiance.xy), packHalf2x16(vec2(v.irradiance.z, v.normal.x)),
                 packHalf2x16(v.normal.yz), packHalf2x16(v.beside[0].xy));
}

uvec4 prt_vertex_pack_1(prt_vertex_light v)
{
    return uvec4(packHalf2x16(vec2(v.beside[0].z, v.beside[1].x)), packHalf2x16(v.beside[1].yz),
                 packHalf2x16(v.beside[2].xy), packHalf2x16(vec2(v.beside[2].z, 0.0)));
}

void prt_vertex_add_0(inout prt_vertex_light sum, float weight, uvec4 words)
{
    vec2 a = unpackHalf2x16(words.x), b = unpackHalf2x16(words.y), c = unpackHalf2x16(words.z);
    sum.irradiance += weight * vec3(a, b.x);
    sum.normal += weight * vec3(b.y, c);
    if (EMITTED) sum.beside[0].xy += weight * unpackHalf2x16(words.w);
}

void prt_vertex_add_1(inout prt_vertex_light sum, float weight, uvec4 words)
{
    vec2 a = unpackHalf2x16(words.x), b = unpackHalf2x16(words.y), c = unpackHalf2x16(words.z);
    sum.beside[0].z += weight * a.x;
    sum.beside[1] += weight * vec3(a.y, b);
    sum.beside[2] += weight * vec3(c, unpackHalf2x16(words.w).x);
}

#endif
