// Radiance from outside of the scene, by direction, in the units of the frame. C twin:
// scene/environment.h. Binding number: ENVIRONMENT_MAP_BINDING. ENVIRONMENT_HAS_MAP, true unless
// defined before: a specialization constant, since software drivers run both sides of a branch.
#ifndef AG_FRAME_ENVIRONMENT_MAP_GLSL
#define AG_FRAME_ENVIRONMENT_MAP_GLSL

#include "frame/frame.glsl"

#ifndef ENVIRONMENT_HAS_MAP
#define ENVIRONMENT_HAS_MAP true
#endif

layout(set = 0, binding = ENVIRONMENT_MAP_BINDING) uniform samplerCube environment_map;

// Mean over a lobe about a direction of any length. sigma: its standard deviation for each of two
// axes, rad; 0: the radiance from the direction.
vec3 environment_lobe(vec3 direction, float sigma)
{
    if (!ENVIRONMENT_HAS_MAP || frame.environment_scale == 0.0) return frame.uniform_sky;
    vec3 at =
        vec3(frame.environment_cos * direction.x - frame.environment_sin * direction.z, direction.y,
             frame.environment_sin * direction.x + frame.environment_cos * direction.z);
    // Level l has lobes of (π/4) 2^l / side, which interpolation between texels makes √2 as wide.
    float level = log2(max(sigma * frame.environment_side * (4.0 / (sqrt(2.0) * PI)), 1.0));
    return frame.uniform_sky + frame.environment_scale * textureLod(environment_map, at, level).rgb;
}

vec3 environment_radiance(vec3 direction)
{
    return environment_lobe(direction, 0.0);
}

// A cone of uniform weight has a standard deviation of half its half-angle.
vec3 environment_cone(vec3 direction, float half_angle)
{
    return environment_lobe(direction, 0.5 * half_angle);
}

#endif
