// What cones found, as vectors: see (1) in vct_cones.glsl. Include after core/half.glsl.
#ifndef AG_VCT_VECTORS_GLSL
#define AG_VCT_VECTORS_GLSL

#include "techniques/vct/vct_ways.glsl"

const float VCT_PI = 3.14159265;

struct vct_vectors
{
    mat3 light; // columns: Σ L d of red, green and blue
    vec3 way;   // Σ d
};

void vct_add_cone(inout vct_vectors v, vec3 radiance, vec3 weighted_direction)
{
    v.light += outerProduct(weighted_direction, radiance);
    v.way += weighted_direction;
}

vec3 vct_irradiance(vct_vectors v, vec3 n, float gain)
{
    float share = dot(n, v.way);
    float nothing = VCT_OCCLUSION ? 1.0 : 0.0; // where no cone says anything, as where there is no surface
    return share > 0.0 ? clamp(n * v.light * (VCT_PI * gain / share), 0.0, HALF_MAX) : vec3(nothing);
}

#endif
