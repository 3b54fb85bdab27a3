// Light from outside of the scene, in the units of the frame: its mean and its spherical harmonics.
// Radiance by direction: environment_map.glsl. C twin: scene/environment.h.
#ifndef AG_FRAME_ENVIRONMENT_GLSL
#define AG_FRAME_ENVIRONMENT_GLSL

#include "core/sh.glsl"
#include "frame/frame.glsl"

// Mean radiance over all directions: for light that was baked for a uniform sky.
vec3 environment_mean()
{
    return frame.sky;
}

// Irradiance by its transfer of 9 coefficients; at least 0, which a projection may not be.
vec3 environment_irradiance(float transfer[9])
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 9; i++) sum += transfer[i] * frame.environment_sh[i];
    return max(sum, vec3(0.0));
}

// Irradiance of a surface that sees all of its hemisphere; at least 0.
vec3 environment_irradiance_at(vec3 normal)
{
    float transfer[9];
    sh9_clamped_cosine(normal, transfer);
    return environment_irradiance(transfer);
}

// Irradiance coefficients of the environment as a point sees it. transfer: those of a visible sky
// of radiance 1. The radiance times the visibility is projected by a quadrature that is exact for
// products of three functions of 9 coefficients: Gauss-Legendre in z, equal steps in azimuth.
void environment_through(float transfer[9], out vec3 irradiance[9])
{
    const float z[4] = float[4](-0.86113631, -0.33998104, 0.33998104, 0.86113631);
    const float weight[4] = float[4](0.34785485, 0.65214515, 0.65214515, 0.34785485);
    float visibility[9], basis[9];
    for (int i = 0; i < 9; i++) visibility[i] = transfer[i] / sh9_cosine_weight(i);
    for (int i = 0; i < 9; i++) irradiance[i] = vec3(0.0);
    for (int k = 0; k < 28; k++) {
        float azimuth = float(k % 7) * (2.0 * PI / 7.0), height = z[k / 7];
        float radius = sqrt(1.0 - height * height);
        vec3 direction = vec3(radius * cos(azimuth), radius * sin(azimuth), height);
        sh9_eval(direction, basis);
        vec3 seen = sh9_dot(visibility, direction) * sh9_dot(frame.environment_sh, direction) *
                    (weight[k / 7] * (2.0 * PI / 7.0));
        for (int i = 0; i < 9; i++) irradiance[i] += seen * basis[i];
    }
    for (int i = 0; i < 9; i++) irradiance[i] *= sh9_cosine_weight(i);
}

#endif
