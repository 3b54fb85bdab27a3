// Light from outside of the scene, in the units of the frame. C twin: scene/environment.h.
#ifndef AG_FRAME_ENVIRONMENT_GLSL
#define AG_FRAME_ENVIRONMENT_GLSL

#include "frame/frame.glsl"

// From a direction of any length.
vec3 environment_radiance(vec3 direction)
{
    return frame.sky;
}

// Over all directions: for light that was baked for a uniform sky.
vec3 environment_mean()
{
    return frame.sky;
}

#endif
