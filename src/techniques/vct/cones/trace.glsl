// Marches one cone through the light volume (Crassin et al. 2011; Hong 2015, sec. 2.5.3.3.7). The
// paper's printed accumulation multiplies the colour by the old opacity, which is a mistake. Front
// to back, with c₂ premultiplied by α₂, it is
//     c ← c + (1 − α) c₂,   α ← α + (1 − α) α₂. (1)
// A step is as long as a texel of the sampled level, so that opacity needs no correction for the
// step size.
//
// Differs from the paper in five ways.
//
// Sheets. Filtering splits the opacity of an opaque sheet between consecutive samples; at a slant
// there are more of them, in proportion to the path length through the sheet. (1) treats them as
// independent layers, and a sixth to a third of the light leaks through every closed wall. For
// sheets the correct sum is
//     c ← c + c₂,   α ← α + α₂,   up to α = 1. (2)
// Texels that are filled only in part are independent occluders, as (1) assumes. volume/over.glsl
// blends (1) and (2) by the largest opacity per axis of this sample and the previous one together.
//
// The start. The first sample has only part of the opacity of a sheet closer than a texel, and the
// volume stores a sheet up to half a texel off its position: at the foot of a wall a cone would see
// through the floor. So a sample half a texel back is added. It is offset and weighted tangentially
// only, since along the normal lie the surface itself and the far side of a thin wall. The light of
// both samples is weighted by the fraction of their opacity that is ahead.
//
// The receiver. Samples exclude the sheet of the surface on which the cone starts: see
// cones/receiver.glsl.
//
// Coarser levels. A sheet is stored at the centre of its texels, which differs by half a finer
// texel from level to level: a sheet between the last sample of one level and the first of the
// next may be behind the latter. A step to a coarser level is therefore as long as the finer texel:
// half of the coarser one more would transmit up to half of the light.
//
// Levels. A cone stays in the clip-map level that it starts in until it leaves the level's box
// (clipmap/clipmap.glsl) or its width needs a coarser one.
#ifndef AG_VCT_TRACE_GLSL
#define AG_VCT_TRACE_GLSL

#include "techniques/vct/clipmap/clipmap.glsl"

struct vct_volume_sample {
    vec4 light; // premultiplied radiance, opacity
    vec3 axes;  // opacity per axis, 0 for axes of weight 0
};

#if VCT_SVO
#include "techniques/vct/octree/sample.glsl"
#else
#include "techniques/vct/volume/sample.glsl"
#endif

const float VCT_NEGLIGIBLE = 0.005; // occlusion: a cone ends when it can add no more than this
const float VCT_OPAQUE = 0.98;      // a cone of this opacity ends and counts as opaque

#include "techniques/vct/volume/over.glsl"
#include "techniques/vct/cones/receiver.glsl"

// Distance along the ray to the exit plane of a box, per axis.
vec3 vct_exit_distances(vec3 low, vec3 high, vec3 from, vec3 direction)
{
    vec3 ends = mix(low, high, greaterThan(direction, vec3(0.0)));
    bvec3 parallel = lessThan(abs(direction), vec3(1e-6));
    return mix((ends - from) / mix(direction, vec3(1.0), parallel), vec3(1e6), parallel);
}

// Whether a ray has left the volume. Filtering extends it to a texel beyond the outermost centres.
bool vct_beyond(vec3 at, vec3 direction, float texel)
{
    vec3 size = ceil(clips.size / texel) * texel;
    vec3 past = mix(-at, at - size, greaterThan(direction, vec3(0.0)));
    return max(past.x, max(past.y, past.z)) > (1.0 - VCT_TEXEL_CENTRE) * texel;
}

// Premultiplied radiance and opacity. Lengths in texels of level 0. at: the surface; normal: of the
// surface; offset: of the cone's apex along the normal; width: texel size over distance; first:
// finest level to sample.
vec4 vct_trace(sampler3D light, vec3 at, vec3 normal, vec3 direction, float offset, float width,
               uint last_mip, int first)
{
    vec4 sum = vec4(0.0);
    vct_receiver receiver = vct_receiver_at(at, normal);
    vec3 from = at + offset * normal, tangential = direction - dot(direction, normal) * normal;
    vct_volume_sample behind = vct_sample_others(
        light, receiver, from - 0.5 * float(1 << first) * tangential, direction, tangential, first);
    vec3 previous_axes = behind.axes;
    float level_exits[VCT_MAX_CLIPS]; // distances, all levels but the coarsest
    for (int k = 0; k < VCT_CLIPS - 1; k++) {
        vec3 axis_exits =
            vct_exit_distances(clips.levels[k].low, clips.levels[k].high, from, direction);
        level_exits[k] = min(axis_exits.x, min(axis_exits.y, axis_exits.z));
    }
    // Decay per texel of level 0.
    float distance = 0.5 * float(1 << first),
          decay = 2.0 * vct.cell_m * vct.decay_per_m / float(1 << (VCT_CLIPS - 1)),
          ahead_of_surface = offset * dot(normal, direction);
    int level = first;
    for (int i = 0; i < 256 * VCT_CLIPS; i++) {
        float start = distance - 0.5 * float(1 << level);
        int wide = min(int(log2(max(width * start, 1.0)) + 0.5), int(last_mip) + VCT_CLIPS - 1);
        for (int k = 0; k < VCT_CLIPS - 1; k++)
            if (distance > level_exits[k]) wide = max(wide, k + 1);
        level = max(level, wide);
        float texel = float(1 << level);
        vec3 middle = from + direction * distance;
        if (vct_beyond(middle, direction, texel)) break;
        vct_volume_sample here =
            vct_sample_others(light, receiver, middle, direction, direction, level);
        if (i == 0) {
            float ahead =
                smoothstep(0.25, 0.5, here.light.a / max(here.light.a + behind.light.a, 1e-6));
            here.light += behind.light;
            here.light.rgb *= ahead;
        }
        float alpha = here.light.a;
        if (VCT_OCCLUSION)
            here.light.rgb = vec3(alpha / (1.0 + decay * (ahead_of_surface + distance)));
        if (alpha > 0.0) {
            vec3 both = previous_axes + here.axes;
            float sheet = min(max(both.x, max(both.y, both.z)), 1.0);
            sum += vct_visible_alpha(1.0 - sum.a, alpha, sheet) * vec4(here.light.rgb / alpha, 1.0);
            if (sum.a > VCT_OPAQUE) return vec4(sum.rgb / sum.a, 1.0);
        }
        if (VCT_OCCLUSION &&
            1.0 - sum.a < VCT_NEGLIGIBLE * (1.0 + decay * (ahead_of_surface + distance)))
            break;
        previous_axes = here.axes;
        distance += texel;
    }
    return sum;
}

// Radiance and opacity of a cone from a surface point, blended over two levels near the border of
// the finer one. offset: of the apex along the normal, in texels of the start level.
vec4 vct_cone(sampler3D light, vec3 at, vec3 normal, vec3 direction, float offset, float width,
              uint last_mip, vct_start start)
{
    if (VCT_CLIPS == 1) return vct_trace(light, at, normal, direction, offset, width, last_mip, 0);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < (start.next > 0.0 ? 2 : 1); i++) {
        int level = start.level + i;
        vec4 traced = vct_trace(light, at, normal, direction, offset * float(1 << level), width,
                                last_mip, level);
        sum += (i == 0 ? 1.0 - start.next : start.next) * traced;
    }
    return sum;
}

#endif
