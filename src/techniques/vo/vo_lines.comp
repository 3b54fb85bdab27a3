// Volumetric obscurance by lines (Loos 2015, sec. 6.3.1, 6.3.3, 6.3.4): the visible share of each
// chord of the sphere, weighted with the volume that the chord represents.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vo/vo_estimate.glsl"

// The disk's axes in pixels, and the slope of the tangent plane along them.
struct vo_disk {
    mat2 pixels;
    vec2 slope;
};

// Open length of a line, from the sphere's front to its back or to the tangent plane.
float open_on(vo_point p, vo_disk disk, vec2 at, float tangent, float half_length)
{
    float top = WITH_NORMAL ? clamp(tangent, -half_length, half_length) : half_length;
    return vo_open(tangent + vo_behind(p, disk.pixels * at), -half_length, top, p.thickness);
}

// Weighted open length of two opposite lines. Their lengths in front of the tangent plane add up to
// one line's length.
float open_on_pair(vo_point p, vo_disk disk, vec4 line)
{
    float tangent = dot(disk.slope, line.xy);
    return line.w * (open_on(p, disk, line.xy, tangent, line.z) +
                     open_on(p, disk, -line.xy, -tangent, line.z));
}

float open_on_one(vo_point p, vo_disk disk, vec4 line)
{
    float tangent = dot(disk.slope, line.xy);
    float top = WITH_NORMAL ? clamp(tangent, -line.z, line.z) : line.z;
    return open_on(p, disk, line.xy, tangent, line.z) / (top + line.z);
}

float vo_visibility(vo_point p)
{
    mat2 turn = screen_reflection(p.pattern);
    vo_disk disk;
    disk.pixels = mat2(screen_stretch(p.sphere, turn[0]), screen_stretch(p.sphere, turn[1])) *
                  p.sphere.radius_px;
    disk.slope = turn * p.plane.on_disk;
    if (COUNT == 1) return open_on_one(p, disk, table.at[0]);
    float full = WITH_NORMAL ? 0.5 : 1.0; // share of the sphere, by the set's symmetry
    float visible = 0.5 * table.center * vo_open(0.0, -1.0, 2.0 * full - 1.0, p.thickness);
    [[unroll]] for (int i = 0; i < COUNT; i += 2) visible += open_on_pair(p, disk, table.at[i]);
    return visible / full;
}
