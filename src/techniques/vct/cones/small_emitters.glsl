// Direct light of small emitters by shadow cones: diffuse cones hit them by chance or not at all.
// An emitter is a group of emissive surfaces whose sample points have equal flux. The irradiance of
// one of intensity I = L a along its normal is at normal incidence
//     I cos θ / (d² + a/π), (1)
// with a the emitter's area per point. It is exact at a large distance and on the axis of a disk.
// The light volume gives the visibility; with rays, the faces of the voxels do.
//
// The number of samples is independent of the number of emitters. Each sample selects one emitter
// in proportion to its unoccluded irradiance (resampled importance sampling: Talbot et al. 2005).
//
// Include after cones/trace.glsl, and after rays/ray.glsl where pixels or voxels trace rays, with
// the uniform block vct_cones as `set`. Binding: VCT_SMALL_EMITTERS_BINDING.
#ifndef AG_VCT_SMALL_EMITTERS_GLSL
#define AG_VCT_SMALL_EMITTERS_GLSL

#include "techniques/vct/vct_constants.h"
#include "techniques/vct/cones/cones_shared.h"

layout(set = 0, binding = VCT_SMALL_EMITTERS_BINDING, scalar) readonly buffer vct_small_emitters
{
    vct_small_emitter small_emitters[];
};

layout(constant_id = VCT_CONSTANT_SMALL_EMITTERS) const bool VCT_HAS_SMALL_EMITTERS = false;

// Texel size over the distance from either end of the shadow cone, by measurement: the width at the
// receiver sets the sharpness of shadows, the width at the emitter only has to exclude its mount.
const float VCT_WIDTH_FROM_SURFACE = 0.15, VCT_WIDTH_FROM_EMITTER = 0.5;
// Texels around a sample point in which occluders are ignored: they are the emitter itself.
const float VCT_EMITTER_NEAR = 1.5;
const float VCT_EMITTER_NEAR_RAY = 0.25; // the same for rays, in voxels

// Visibility between a surface and an emitter; both ends are offset from their surfaces. Lengths in
// texels of level 0. first: level at the receiver. Sheets and the start are as in vct_trace.
float vct_emitter_visibility(sampler3D light, vec3 at, vec3 normal, int first, vec3 to,
                             vec3 emitter_normal)
{
    vec3 from = at + set.offset * float(1 << first) * normal,
         path = to + set.offset * vct_texel_at(to) * emitter_normal - from;
    float distance = length(path), end = distance - VCT_EMITTER_NEAR * vct_texel_at(to);
    if (end <= 0.0) return 1.0;
    vec3 direction = path / distance;
    float narrowing = -VCT_WIDTH_FROM_EMITTER * dot(direction, emitter_normal);
    vec3 tangential = direction - dot(direction, normal) * normal;
    vct_receiver receiver = vct_receiver_at(at, normal);
    vct_volume_sample behind = vct_sample_others(
        light, receiver, from - 0.5 * float(1 << first) * tangential, direction, tangential, first);
    vec3 previous_axes = behind.axes;
    float occlusion = 0.0, t = 0.0;
    for (int i = 0; i < 256 * VCT_CLIPS && t < end; i++) {
        float width = min(VCT_WIDTH_FROM_SURFACE * t, narrowing * (end - t));
        int level = min(int(log2(max(width, 1.0)) + 0.5), int(set.last_mip) + VCT_CLIPS - 1);
        if (VCT_CLIPS > 1)
            level = max(level, i == 0 ? first : vct_start_at(from + t * direction).level);
        float texel = float(1 << level);
        vct_volume_sample here =
            vct_sample_others(light, receiver, from + direction * min(t + 0.5 * texel, end),
                              direction, direction, level);
        float alpha = here.light.a + (i == 0 ? behind.light.a : 0.0);
        vec3 both = previous_axes + here.axes;
        occlusion +=
            vct_visible_alpha(1.0 - occlusion, alpha, min(max(both.x, max(both.y, both.z)), 1.0));
        if (occlusion > VCT_OPAQUE) return 0.0;
        previous_axes = here.axes;
        t += texel;
    }
    return 1.0 - occlusion;
}

// (1) on a surface at normal incidence. to: unit, to the emitter.
vec3 vct_emitter_point_irradiance(uint emitter, uint point, vec3 position, out vec3 to)
{
    vec3 path = small_emitters[emitter].positions[point] - position;
    float d2 = dot(path, path);
    to = path * inversesqrt(max(d2, 1e-12));
    float cosine = -dot(small_emitters[emitter].normals[point], to);
    bool both_sides = (small_emitters[emitter].both_sides >> point & 1u) != 0u;
    cosine = both_sides ? abs(cosine) : max(cosine, 0.0);
    return small_emitters[emitter].intensities[point] *
           (cosine / max(d2 + small_emitters[emitter].area_m2 / PI, 1e-12));
}

struct vct_emitter_sample {
    vec3 light;          // unoccluded irradiance of all emitters at normal incidence, scaled lux
    vec3 to;             // unit, to the emitter
    vec3 at;             // sample point, world space
    vec3 emitter_normal; // unit, normal of the emitter towards the surface
};

vct_emitter_sample vct_sample_emitters(uint point, vec3 position, vec3 normal)
{
    vct_emitter_sample s = vct_emitter_sample(vec3(0.0), normal, position, normal);
    float u = fract(0.5 + 0.61803399 * float(point)), sum = 0.0, selected_weight = 1.0;
    for (uint i = 0u; i < uint(small_emitters.length()); i++) {
        vec3 to, light = vct_emitter_point_irradiance(i, point, position, to);
        float weight = max(dot(normal, to), 0.0) * dot(light, vec3(0.2126, 0.7152, 0.0722));
        if (weight <= 0.0) continue;
        sum += weight;
        float probability = weight / sum;
        bool selected = u < probability;
        u = selected ? u / probability : (u - probability) / (1.0 - probability);
        if (!selected) continue;
        vec3 emitter_normal = small_emitters[i].normals[point];
        s = vct_emitter_sample(light, to, small_emitters[i].positions[point],
                               dot(emitter_normal, to) < 0.0 ? emitter_normal : -emitter_normal);
        selected_weight = weight;
    }
    s.light *= sum / selected_weight;
    return s;
}

// Irradiance of one sample at normal incidence on a surface at `at`, in texels of level 0. first:
// level there.
vec3 vct_small_emitter_light(sampler3D light, uint point, vec3 at, vec3 normal, int first,
                             out vec3 to)
{
    vct_emitter_sample s = vct_sample_emitters(point, clips.origin_m + set.texel_m * at, normal);
    to = s.to;
    if (s.light == vec3(0.0)) return vec3(0.0);
    vec3 emitter_at = (s.at - clips.origin_m) / set.texel_m;
#ifdef AG_VCT_RAY_GLSL
    if (VCT_RAYS)
        return s.light * vct_ray_visibility(at, normal, emitter_at, VCT_EMITTER_NEAR_RAY, first);
#endif
    return s.light * vct_emitter_visibility(light, at, normal, first, emitter_at, s.emitter_normal);
}

#endif
