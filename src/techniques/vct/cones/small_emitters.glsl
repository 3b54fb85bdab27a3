// Light of lamps, on its straight way: small things that glow, which a cone of many meets by chance
// or not at all. Of points spread evenly over a lamp each has an irradiance for what faces it of
//     L a cos θ / (d² + a/π), (1)
// with its share a of the lamp's area, which is right far off and, as a disk's on its axis is,
// nearby. What stands in the way is asked of the light volume.
//
// There are so many samples for all lamps together: each looks at one lamp, chosen in proportion to
// what its point would bring if nothing were in the way, and stands for all (resampling: Talbot et
// al. 2005).
//
// Include after cones/trace.glsl, with the uniform block vct_cones as `set`. Binding:
// VCT_LAMPS_BINDING.
#ifndef AG_VCT_SMALL_EMITTERS_GLSL
#define AG_VCT_SMALL_EMITTERS_GLSL

#include "techniques/vct/vct_constants.h"
#include "techniques/vct/cones/cones_shared.h"

layout(set = 0, binding = VCT_SMALL_EMITTERS_BINDING, scalar) readonly buffer vct_small_emitters
{
    vct_small_emitter small_emitters[];
};

layout(constant_id = VCT_CONSTANT_SMALL_EMITTERS) const bool VCT_HAS_SMALL_EMITTERS = false;

// Widths of texels on the way, over the distance from its ends. By measurement: shadows show how
// narrow it is where it begins; where it ends it may be wide, as long as texels are clear of what
// the lamp is fastened to.
const float VCT_WIDTH_FROM_SURFACE = 0.15, VCT_WIDTH_FROM_EMITTER = 0.5;
const float VCT_EMITTER_NEAR = 1.5; // texels: what is so near to a lamp's point is the lamp itself

// What part of the light is left on the way from a surface to a lamp; each end is a bit off the
// surface there. Lengths in texels of level 0; first: the level at the beginning. Sheets and the
// start: see vct_trace.
float vct_emitter_visibility(sampler3D light, vec3 at, vec3 normal, int first, vec3 to, vec3 off)
{
    vec3 from = at + set.offset * float(1 << first) * normal,
         direction_index = to + set.offset * vct_texel_at(to) * off - from;
    float distance = length(direction_index), end = distance - VCT_EMITTER_NEAR * vct_texel_at(to);
    if (end <= 0.0) return 1.0;
    vec3 direction = direction_index / distance;
    float clear = -VCT_WIDTH_FROM_EMITTER * dot(direction, off);
    vec3 level_with = direction - dot(direction, normal) * normal;
    vct_volume_sample behind = vct_sample_volume(light, from - 0.5 * float(1 << first) * level_with,
                                                 direction, level_with, first);
    vec3 before = behind.axes;
    float met = 0.0, t = 0.0;
    for (int i = 0; i < 256 * VCT_CLIPS && t < end; i++) {
        float wide = min(VCT_WIDTH_FROM_SURFACE * t, clear * (end - t));
        int level = min(int(log2(max(wide, 1.0)) + 0.5), int(set.last_mip) + VCT_CLIPS - 1);
        if (VCT_CLIPS > 1)
            level = max(level, i == 0 ? first : vct_start_at(from + t * direction).level);
        float texel = float(1 << level);
        vct_volume_sample here = vct_sample_volume(
            light, from + direction * min(t + 0.5 * texel, end), direction, direction, level);
        float alpha = here.light.a + (i == 0 ? behind.light.a : 0.0);
        vec3 two = before + here.axes;
        met += vct_visible_alpha(1.0 - met, alpha, min(max(two.x, max(two.y, two.z)), 1.0));
        if (met > VCT_OPAQUE) return 0.0;
        before = here.axes;
        t += texel;
    }
    return 1.0 - met;
}

// (1), for a surface that faces the lamp; `to`: the way there, unit.
vec3 vct_emitter_point_irradiance(uint emitter, uint point, vec3 position, out vec3 to)
{
    vec3 direction_index = small_emitters[emitter].positions[point] - position;
    float d2 = dot(direction_index, direction_index), a = small_emitters[emitter].area_m2;
    to = direction_index * inversesqrt(max(d2, 1e-12));
    float cosine = -dot(small_emitters[emitter].normals[point], to);
    cosine = small_emitters[emitter].both_sides != 0u ? abs(cosine) : max(cosine, 0.0);
    return small_emitters[emitter].radiance * (a * cosine / max(d2 + a / 3.14159265, 1e-12));
}

struct vct_emitter_sample {
    vec3 light; // scaled lux on what faces it, were nothing in the way; for all lamps
    vec3 to;    // unit
    vec3 at;    // where it comes from, world space
    vec3 off;   // unit: off the lamp there, to the surface's side
};

vct_emitter_sample vct_sample_emitters(uint point, vec3 position, vec3 normal)
{
    vct_emitter_sample s = vct_emitter_sample(vec3(0.0), normal, position, normal);
    float u = fract(0.5 + 0.61803399 * float(point)), sum = 0.0, its = 1.0;
    for (uint i = 0u; i < uint(small_emitters.length()); i++) {
        vec3 to, light = vct_emitter_point_irradiance(i, point, position, to);
        float weight = max(dot(normal, to), 0.0) * dot(light, vec3(0.2126, 0.7152, 0.0722));
        if (weight <= 0.0) continue;
        sum += weight;
        float share = weight / sum;
        bool taken = u < share;
        u = taken ? u / share : (u - share) / (1.0 - share);
        if (!taken) continue;
        vec3 off = small_emitters[i].normals[point];
        s = vct_emitter_sample(light, to, small_emitters[i].positions[point],
                               dot(off, to) < 0.0 ? off : -off);
        its = weight;
    }
    s.light *= sum / its;
    return s;
}

// The light of one sample on a surface at a place (texels of level 0) that faces it. first: the
// level there.
vec3 vct_small_emitter_light(sampler3D light, uint point, vec3 at, vec3 normal, int first,
                             out vec3 to)
{
    vct_emitter_sample s = vct_sample_emitters(point, clips.origin_m + set.texel_m * at, normal);
    to = s.to;
    if (s.light == vec3(0.0)) return vec3(0.0);
    return s.light * vct_emitter_visibility(light, at, normal, first,
                                            (s.at - clips.origin_m) / set.texel_m, s.off);
}

#endif
