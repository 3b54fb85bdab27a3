// Volumetric obscurance by lines (Loos 2015, sec. 6.3.1, 6.3.3, 6.3.4): of each line through the sphere, the length that is
// visible over its length, weighted with the volume that the line stands for.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vo/vo_estimate.glsl"

float vo_visibility(vo_place p)
{
    mat2 turn = screen_reflection(p.pattern);
    mat2 pixels = mat2(screen_stretch(p.sphere, turn[0]), screen_stretch(p.sphere, turn[1])) * p.sphere.radius_px;
    vec2 slope = turn * p.plane.on_disk;
    float top_at_centre = WITH_NORMAL ? 0.0 : 1.0;
    float visible = 0.5 * table.centre * vo_open(0.0, -1.0, top_at_centre, p.thickness);
    float full = 0.5 * table.centre * (top_at_centre + 1.0);
    [[dont_unroll]] for (int i = 0; i < COUNT; i++) {
        vec4 line = table.at[i];
        float tangent = dot(slope, line.xy);
        float top = WITH_NORMAL ? clamp(tangent, -line.z, line.z) : line.z;
        visible += line.w * vo_open(tangent + vo_behind(p, pixels * line.xy), -line.z, top, p.thickness);
        full += line.w * (top + line.z);
    }
    return visible / full;
}
