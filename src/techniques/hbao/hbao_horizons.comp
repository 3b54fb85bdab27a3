// Ambient occlusion by horizons (Bavoil & Sainz 2008): along each of some directions on the screen the horizon rises from the
// tangent plane. With elevations α measured from the plane across the line of sight, what lies between the tangent t and the
// horizon h is 1/2π ∫ (sin h − sin t) dθ of the hemisphere, each rise weighted with the fall-off at the sample that makes it.
//
// Samples are in radii, in the sphere's frame of screen_ao.glsl: x and y across the line of sight, z along it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/octahedral.glsl"
#include "techniques/common/screen_ao.glsl"
#include "techniques/hbao/hbao_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    hbao_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3, rg32f) uniform writeonly image2D estimate;

// Sine of the elevation whose tangent is t.
float sine(float t)
{
    return t * inversesqrt(1.0 + t * t);
}

float occlusion(ivec2 pixel, screen_sphere sphere, screen_plane plane, vec2 direction, float first)
{
    vec2 pixels = screen_stretch(sphere, direction) * sphere.radius_px;
    float slope = -dot(plane.on_disk, direction); // towards the eye
    float highest = sine((slope + push.bias) / max(1.0 - slope * push.bias, 1.0e-3)), sum = 0.0;
    for (int i = 0; i < push.steps; i++) {
        float across = (float(i) + first) / float(push.steps);
        ivec2 there = pixel + ivec2(round(pixels * across));
        if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, ivec2(view.width, view.height)))) break;
        float behind = screen_behind(sphere, plane, vec2(there - pixel), texelFetch(depth, there, 0).r);
        float up = slope * across - min(behind + plane.tolerance, 0.0);
        float r = sqrt(across * across + up * up);
        float elevation = up / r;
        float weight = 1.0 - r * r * (push.quadratic != 0 ? 1.0 : r);
        if (elevation <= highest || weight <= 0.0) continue;
        sum += weight * (elevation - highest);
        highest = elevation;
    }
    return sum;
}

float visibility(ivec2 work, ivec2 pixel, screen_sphere sphere, vec3 n)
{
    screen_plane plane = screen_plane_of(sphere, n);
    uint pattern = screen_pattern(uvec2(work));
    float turn = screen_turn(pattern);
    float first = (float((pattern * 5u) & 15u) + 0.5) / 16.0; // of 16 samples in the first step, in another order than turns
    float sum = 0.0;
    for (int i = 0; i < push.directions; i++) {
        float angle = 6.28318531 * (float(i) + turn) / float(push.directions);
        sum += occlusion(pixel, sphere, plane, vec2(cos(angle), sin(angle)), first);
    }
    return 1.0 - sum / float(push.directions);
}

void main()
{
    ivec2 work = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(work, ivec2(view.work_width, view.work_height)))) return;
    ivec2 pixel = work * SCREEN_AO_STEP;
    float here = texelFetch(depth, pixel, 0).r;
    float result = 1.0;
    if (here > 0.0) {
        screen_sphere sphere = screen_sphere_at(pixel, here, view.radius_m);
        vec3 n = screen_normal(octahedral_decode(texelFetch(normal, pixel, 0).rg));
        result = mix(1.0, visibility(work, pixel, sphere, n), screen_fade(sphere));
    }
    imageStore(estimate, work, vec4(clamp(result, 0.0, 1.0), here, 0.0, 0.0));
}
