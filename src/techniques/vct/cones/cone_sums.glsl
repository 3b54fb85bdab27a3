// What cones found, as vectors: see (1) in cones/cones.comp. Include after core/half.glsl.
#ifndef AG_VCT_VECTORS_GLSL
#define AG_VCT_VECTORS_GLSL

#include "techniques/vct/volume/directions.glsl"

const float VCT_PI = 3.14159265;

struct vct_cone_sums {
    mat3 light;           // columns: Σ L d of red, green and blue
    vec3 direction_index; // Σ d
};

void vct_add_cone(inout vct_cone_sums v, vec3 radiance, vec3 weighted_direction)
{
    v.light += outerProduct(weighted_direction, radiance);
    v.direction_index += weighted_direction;
}

const float VCT_LEAST_COSINE =
    0.7; // of a normal with Σ d: the hemispheres of both have most in common

// A normal turned towards Σ d where it is far from it. There (1) counts light from below the normal
// as if it took away from what comes from above.
vec3 vct_within_reach(vct_cone_sums v, vec3 n)
{
    vec3 middle =
        v.direction_index * inversesqrt(max(dot(v.direction_index, v.direction_index), 1e-12));
    float cosine = dot(n, middle);
    vec3 across = n - cosine * middle;
    float length2 = dot(across, across);
    if (cosine >= VCT_LEAST_COSINE || length2 < 1e-6) return n;
    return VCT_LEAST_COSINE * middle +
           across * (sqrt(1.0 - VCT_LEAST_COSINE * VCT_LEAST_COSINE) * inversesqrt(length2));
}

vec3 vct_irradiance(vct_cone_sums v, vec3 n, float gain)
{
    n = vct_within_reach(v, n);
    float share = dot(n, v.direction_index);
    float nothing =
        VCT_OCCLUSION ? 1.0 : 0.0; // where no cone says anything, as where there is no surface
    return share > 0.0 ? clamp(n * v.light * (VCT_PI * gain / share), 0.0, HALF_MAX)
                       : vec3(nothing);
}

#endif
