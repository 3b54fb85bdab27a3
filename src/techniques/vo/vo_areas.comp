// Volumetric obscurance by areas (Loos 2015, sec. 6.3.2): the depths in a sample's area are
// modelled as a uniform distribution with the pyramid's mean and variance.
//
// Each sample fetches one texel, half as wide as its area. The patterns jitter the position by a
// texel and the level by one; the blur then acts as a filter with many taps.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/vo/vo_estimate.glsl"

layout(set = 0, binding = 5) uniform sampler2D moments; // level 0 is half resolution

const vec4 WHOLE = vec4(0.0, 0.0, 1.0, 0.5); // a single area sample: the whole disk
const float THINNEST = 1.0e-4;               // half-width of a box, radii

// Variance of the tangent plane's depths over a texel.
float plane_variance(vec2 slope, float texel_px)
{
    return dot(slope, slope) * (texel_px * texel_px - 1.0) / 12.0;
}

struct vo_box {
    float middle, half_width;
};

// Distribution of depths relative to the tangent plane around an offset in pixels. The plane's own
// variance is subtracted.
vo_box box_at(vo_point p, vec2 offset, int level)
{
    float texel_px = float(1 << level);
    vec2 jitter = (vec2(p.pattern & 3u, p.pattern >> 2u) - 1.5) / 4.0; // texels
    // No textureSize: software drivers evaluated its level for one invocation of a group only.
    vec2 here = vec2(p.pixel) + 0.5,
         last = vec2(max(ivec2(view.width, view.height) >> level, 1) - 1);
    vec2 texel = clamp(floor((here + offset) * (1.0 / texel_px) + jitter), vec2(0.0), last);
    vec2 depths = texelFetch(moments, ivec2(texel), level - 1).rg;
    vec2 step = (texel + 0.5) * texel_px - here;
    float to_z = p.sphere.z_per_depth;
    float tolerance = p.plane.tolerance;
    // An error t of the slope s changes its square by t (t + 2s), and 2s ≤ 1 + s².
    float rounding = tolerance * (tolerance + 1.0 + dot(p.plane.on_disk, p.plane.on_disk));
    float variance =
        depths.y * to_z * to_z - plane_variance(p.plane.on_screen, texel_px) - rounding;
    float front = screen_behind(p.sphere, p.plane, step, depths.x);
    return vo_box(front + (WITH_NORMAL ? tolerance : 0.0),
                  max(sqrt(3.0 * max(variance, 0.0)), THINNEST));
}

// Integral up to z of the share of depths behind z: 1 in front of the box, 0 behind it.
vec4 open_up_to(vo_box box, vec4 z)
{
    vec4 u = clamp((z - box.middle) * (0.5 / box.half_width) + 0.5, 0.0, 1.0);
    return min(z, box.middle - box.half_width) + 2.0 * box.half_width * (u - 0.5 * u * u);
}

float open_between(vo_box box, float from, float to, float thickness)
{
    vec4 up_to = open_up_to(box, vec4(from, to, vec2(from, to) - thickness));
    return up_to.y - up_to.x + to - from - (up_to.w - up_to.z);
}

float vo_visibility(vo_point p)
{
    mat2 turn = COUNT == 1 ? mat2(1.0) : screen_reflection(p.pattern);
    mat2 pixels = mat2(screen_stretch(p.sphere, turn[0]), screen_stretch(p.sphere, turn[1])) *
                  p.sphere.radius_px;
    vec2 slope = turn * p.plane.on_disk;
    float dither = (float((p.pattern * 7u) & 15u) + 0.5) / 16.0,
          level = log2(p.sphere.radius_px) + dither;
    float visible = 0.0, full = 0.0;
    for (int i = 0; i < COUNT; i++) {
        vec4 line = COUNT == 1 ? WHOLE : table.at[i];
        int there = clamp(int(floor(level + table.levels[i])), 1, table.level_count);
        vo_box box = box_at(p, pixels * line.xy, there);
        float tangent = dot(slope, line.xy);
        float top = WITH_NORMAL ? clamp(tangent, -line.z, line.z) : line.z;
        box.middle += tangent;
        visible += line.w * open_between(box, -line.z, top, p.thickness);
        full += line.w * (top + line.z);
    }
    return visible / full;
}
