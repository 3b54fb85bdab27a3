// Direction-weighted sums of cone radiance: see (1) in cones/cones.comp. Include after
// core/half.glsl.
#ifndef AG_VCT_CONE_SUMS_GLSL
#define AG_VCT_CONE_SUMS_GLSL

#include "core/math.glsl"
#include "techniques/vct/volume/directions.glsl"

struct vct_cone_sums {
    mat3 light;     // columns: Σ L d of red, green and blue
    vec3 direction; // Σ d
};

void vct_add_cone(inout vct_cone_sums v, vec3 radiance, vec3 weighted_direction)
{
    v.light += outerProduct(weighted_direction, radiance);
    v.direction += weighted_direction;
}

// Between a normal and Σ d: their hemispheres overlap for the most part.
const float VCT_LEAST_COSINE = 0.7;

// Limits the angle between a normal and Σ d. Beyond it (1) subtracts the light from below the
// normal's horizon.
vec3 vct_clamp_normal(vct_cone_sums v, vec3 n)
{
    vec3 middle = v.direction * inversesqrt(max(dot(v.direction, v.direction), 1e-12));
    float cosine = dot(n, middle);
    vec3 across = n - cosine * middle;
    float length2 = dot(across, across);
    if (cosine >= VCT_LEAST_COSINE || length2 < 1e-6) return n;
    return VCT_LEAST_COSINE * middle +
           across * (sqrt(1.0 - VCT_LEAST_COSINE * VCT_LEAST_COSINE) * inversesqrt(length2));
}

vec3 vct_irradiance(vct_cone_sums v, vec3 n, float gain)
{
    n = vct_clamp_normal(v, n);
    float projected = dot(n, v.direction);
    float no_sample = VCT_OCCLUSION ? 1.0 : 0.0; // no cone or no surface
    return projected > 0.0 ? clamp(n * v.light * (PI * gain / projected), 0.0, HALF_MAX)
                           : vec3(no_sample);
}

#endif
