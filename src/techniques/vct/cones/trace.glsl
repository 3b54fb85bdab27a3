// One cone through the light volume (Crassin et al. 2011; Hong 2015, sec. 2.5.3.3.7). The printed
// accumulation multiplies the colour with the old opacity, which is wrong; front to back it is,
// with c₂ premultiplied with α₂,
//     c ← c + (1 − α) c₂,   α ← α + (1 − α) α₂. (1)
// Each step is as long as a texel of the level that it looks at, so that opacities need no
// correction for its length.
//
// Differs in two ways.
//
// Sheets. Samples of a sheet that fills its texels split its opacity between them: filtered, they
// add up to what one sample in its middle would have, and across a sheet that is met at a slant the
// parts are as many as the way through it is long. (1) takes them for sheets behind each other, and
// through every closed wall a sixth to a third of the light beyond is seen. There
//     c ← c + c₂,   α ← α + α₂,   up to α = 1 (2)
// is right. What fills a part of its texels is met once more by chance, as (1) says. How much of a
// sheet there is, 0…1, is the largest opacity along an axis of this sample and the last one
// together, to the fourth power; it blends the two (volume/over.glsl).
//
// The start. The first sample has a part of the sheets that lie less than a texel away, and a sheet
// is where its texel is, half a texel from its place at most: from a wall's foot a floor would be
// seen through. So what lies half a texel back stands in the way too, along the surface alone: off
// it are the surface itself and, behind, the other side of a thin wall. Its light counts where it
// is rather ahead than behind.
//
// Grids. A cone goes on in the grid that it starts in, as long as that one has what comes
// (clipmap/clipmap.glsl), and its width asks for no coarser one.
#ifndef AG_VCT_TRACE_GLSL
#define AG_VCT_TRACE_GLSL

#include "techniques/vct/clipmap/clipmap.glsl"

struct vct_volume_sample {
    vec4 light; // premultiplied radiance, opacity
    vec3 axes;  // opacity along each axis that is looked along
};

#if VCT_SVO
#include "techniques/vct/octree/sample.glsl"
#else
#include "techniques/vct/volume/sample.glsl"
#endif
#include "techniques/vct/volume/over.glsl"

const float VCT_UNSEEN = 0.005; // of occlusion: a cone that can add no more than that ends
const float VCT_OPAQUE = 0.98;  // a cone that has met so much ends there, as if it had met all

// How far it is along each axis until a box ends.
vec3 vct_until(vec3 low, vec3 high, vec3 from, vec3 direction)
{
    vec3 ends = mix(low, high, greaterThan(direction, vec3(0.0)));
    bvec3 across = lessThan(abs(direction), vec3(1e-6));
    return mix((ends - from) / mix(direction, vec3(1.0), across), vec3(1e6), across);
}

// Radiance in xyz, premultiplied, and opacity. Lengths in texels of level 0; `from`: where the cone
// starts, of width 0 there; `normal`: of the surface that it leaves; wide: width of a texel over
// distance; first: the finest level that is looked at.
vec4 vct_trace(sampler3D light, vec3 from, vec3 normal, vec3 direction, float wide, uint last_mip,
               int first)
{
    vec3 until = vct_until(vec3(0.0), clips.size, from, direction);
    float end = min(until.x, min(until.y, until.z));
    vec3 out_of = vec3(lessThanEqual(until, vec3(end))) * direction;
    float out_speed = max(abs(out_of.x), max(abs(out_of.y), abs(out_of.z)));
    vec4 sum = vec4(0.0);
    vec3 level_with = direction - dot(direction, normal) * normal;
    vct_volume_sample behind = vct_sample_volume(light, from - 0.5 * float(1 << first) * level_with,
                                                 direction, level_with, first);
    vec3 before = behind.axes;
    float leaves[VCT_MAX_CLIPS]; // grids but the coarsest one
    for (int k = 0; k < VCT_CLIPS - 1; k++) {
        vec3 there = vct_until(clips.levels[k].low, clips.levels[k].high, from, direction);
        leaves[k] = min(there.x, min(there.y, there.z));
    }
    // In distances of level 0; the offset is in texels of the first.
    float t = 0.0, decay = 2.0 * vct.cell_m * vct.decay_per_m / float(1 << (VCT_CLIPS - 1)),
          ahead_of_surface = vct.offset * float(1 << first) * dot(normal, direction);
    for (int i = 0; i < 256 * VCT_CLIPS; i++) {
        int level =
            max(min(int(log2(max(wide * t, 1.0)) + 0.5), int(last_mip) + VCT_CLIPS - 1), first);
        for (int k = 0; k < VCT_CLIPS - 1; k++)
            if (t + 0.5 * float(1 << k) > leaves[k]) level = max(level, k + 1);
        float texel = float(1 << level), middle = t + 0.5 * texel;
        // The side through which the cone leaves may be a wall, which is filtered out to a texel
        // beyond it.
        bool left_grid = middle > end;
        if (left_grid && (middle - end) * out_speed > texel) break;
        vec3 at = from + direction * min(middle, end);
        vct_volume_sample here =
            vct_sample_volume(light, at, direction, left_grid ? out_of : direction, level);
        if (i == 0) {
            float ahead =
                smoothstep(0.25, 0.5, here.light.a / max(here.light.a + behind.light.a, 1e-6));
            here.light += behind.light;
            here.light.rgb *= ahead;
        }
        float alpha = here.light.a;
        if (VCT_OCCLUSION)
            here.light.rgb = vec3(alpha / (1.0 + decay * (ahead_of_surface + t + 0.5 * texel)));
        if (alpha > 0.0) {
            vec3 two = before + here.axes;
            float sheet = min(max(two.x, max(two.y, two.z)), 1.0);
            sum += vct_visible_alpha(1.0 - sum.a, alpha, sheet) * vec4(here.light.rgb / alpha, 1.0);
            if (sum.a > VCT_OPAQUE) return vec4(sum.rgb / sum.a, 1.0);
        }
        if (VCT_OCCLUSION && 1.0 - sum.a < VCT_UNSEEN * (1.0 + decay * (ahead_of_surface + t)))
            break;
        before = here.axes;
        t += texel;
    }
    return sum;
}

// What a cone brings to a place on a surface. offset: along the normal, in texels of the level that
// it starts with.
vec4 vct_cone(sampler3D light, vec3 at, vec3 normal, vec3 direction, float offset, float wide,
              uint last_mip, vct_start start)
{
    if (VCT_CLIPS == 1)
        return vct_trace(light, at + offset * normal, normal, direction, wide, last_mip, 0);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (start.next > 0.0 ? 2 : 1); i++) {
        int level = start.level + i;
        vec3 from = at + offset * float(1 << level) * normal;
        vec4 met = vct_trace(light, from, normal, direction, wide, last_mip, level);
        sum += (i == 0 ? 1.0 - start.next : start.next) * met;
    }
    return sum;
}

#endif
