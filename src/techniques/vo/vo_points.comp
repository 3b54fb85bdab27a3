// Volumetric obscurance by points (Loos 2015, sec. 6.3, 6.3.4; Mittring 2007; Filion & McNaughton
// 2008), a baseline for lines: a point is visible in front of the surface, or behind its thickness.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vo/vo_estimate.glsl"

const float ON_PLANE = 1.0e-5; // a point on the tangent plane is visible

float vo_visibility(vo_point p)
{
    mat3 turn = screen_reflection_of_ball(p.pattern);
    vec3 outwards = normalize(vec3(p.plane.on_disk, -1.0));
    float visible = table.center * (WITH_NORMAL ? 1.0 : 0.5);
    [[unroll]] for (int i = 0; i < COUNT; i++)
    {
        vec3 point = turn * table.at[i].xyz;
        // Reflects points below the tangent plane.
        if (WITH_NORMAL) point -= 2.0 * min(dot(point, outwards), 0.0) * outwards;
        vec2 offset = p.sphere.radius_px * screen_stretch(p.sphere, point.xy);
        float behind = point.z - dot(p.plane.on_disk, point.xy) - vo_behind(p, offset);
        visible += behind <= ON_PLANE || behind > p.thickness ? table.at[i].w : 0.0;
    }
    return visible;
}
