// Horizon-based ambient occlusion (Bavoil & Sainz 2008): along each screen direction the horizon
// rises from the tangent plane. With elevations measured from the plane perpendicular to the line
// of sight, the occlusion between the tangent t and the horizon h is 1/2π ∫ (sin h − sin t) dθ;
// each rise is weighted with the falloff at its sample.
//
// Samples are in radii, in the frame of screen_ao.glsl: x and y perpendicular to the line of sight,
// z along it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/screen_ao_estimate.glsl"
#include "techniques/hbao/hbao_shared.h"

layout(set = 0, binding = 4, scalar) uniform hbao_table
{
    hbao_params table;
};

// Sine of the elevation whose tangent is t.
float sine(float t)
{
    return t * inversesqrt(1.0 + t * t);
}

float occlusion(ivec2 pixel, screen_sphere sphere, screen_plane plane, vec2 direction, float jitter)
{
    vec2 pixels = screen_stretch(sphere, direction) * sphere.radius_px;
    float slope = -dot(plane.on_disk, direction); // towards the camera
    float highest = sine((slope + table.bias) / max(1.0 - slope * table.bias, 1.0e-3)), sum = 0.0;
    for (int i = 0; i < table.steps; i++) {
        float across = (float(i) + jitter) / float(table.steps);
        ivec2 there = pixel + ivec2(round(pixels * across));
        if (any(lessThan(there, ivec2(0))) ||
            any(greaterThanEqual(there, ivec2(view.width, view.height))))
            break;
        float behind =
            screen_behind(sphere, plane, vec2(there - pixel), texelFetch(depth, there, 0).r);
        float up = slope * across - min(behind + plane.tolerance, 0.0);
        float r = sqrt(across * across + up * up);
        float elevation = up / r;
        float weight = 1.0 - r * r * (table.quadratic != 0 ? 1.0 : r);
        if (elevation <= highest || weight <= 0.0) continue;
        sum += weight * (elevation - highest);
        highest = elevation;
    }
    return sum;
}

float screen_ao_visibility(screen_point point)
{
    screen_sphere sphere = screen_sphere_at(point.pixel, point.depth, view.radius_m);
    screen_plane plane = screen_plane_of(sphere, point.n);
    float rotation = screen_rotation(point.pattern);
    float jitter = screen_jitter(point.pattern);
    float sum = 0.0;
    for (int i = 0; i < table.directions; i++) {
        float angle = 6.28318531 * (float(i) + rotation) / float(table.directions);
        sum += occlusion(point.pixel, sphere, plane, vec2(cos(angle), sin(angle)), jitter);
    }
    return mix(1.0, 1.0 - sum / float(table.directions), screen_fade(sphere));
}
