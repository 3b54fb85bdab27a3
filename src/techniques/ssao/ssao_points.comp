// Ambient occlusion with points in a sphere (Mittring 2007; with the normal, Filion & McNaughton
// 2008): a point is visible if the depth buffer has no surface in front of it. Surfaces far in
// front of the pixel's own are ignored.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/screen_ao_estimate.glsl"
#include "techniques/ssao/ssao_shared.h"

layout(constant_id = SSAO_CONSTANT_COUNT) const int COUNT = 12;
layout(constant_id = SSAO_CONSTANT_NORMAL) const bool WITH_NORMAL = true;

layout(set = 0, binding = 4, scalar) uniform ssao_table
{
    ssao_samples table;
};

const float NEUTRAL = WITH_NORMAL ? 1.0 : 0.5; // visibility of a plane
// Smallest distance of a point, relative to the pixel's: points may lie behind the camera.
const float NEAREST = 1.0e-3;

// The receiver, and members of `view`, loaded once: not in the loop over points.
struct ssao_receiver {
    ivec2 pixel;
    float distance_m, radius_m; // radius_m: bounded by `reach`
    float focal_px, perspective;
    vec4 distance_of_depth;
};

// Distance in radii along the view axis of a surface in front of `distance_m`.
float in_front(ssao_receiver r, float surface, float distance_m)
{
    vec4 m = r.distance_of_depth;
    float surface_m = (m.x + m.y * surface) / (m.z + m.w * surface);
    return surface > 0.0 ? (distance_m - surface_m) / r.radius_m : -1.0e9;
}

float visible(ssao_receiver r, screen_sphere sphere, screen_plane plane, vec3 point)
{
    vec3 at = vec3(sphere.m, 1.0) * r.distance_m + r.radius_m * point;
    at.z = max(at.z, NEAREST * r.distance_m);
    vec2 offset = r.focal_px * (at.xy / mix(1.0, at.z, r.perspective) - sphere.m);
    ivec2 there =
        clamp(r.pixel + ivec2(round(offset)), ivec2(0), ivec2(view.width, view.height) - 1);
    float surface = texelFetch(depth, there, 0).r, tolerance = 0.0;
    if (WITH_NORMAL) {
        // From the pixel's center to the point the surface continues parallel to the tangent plane.
        surface -= dot(plane.on_screen, offset - vec2(there - r.pixel)) / sphere.z_per_depth;
        tolerance = plane.tolerance;
    }
    float open = in_front(r, surface, at.z) <= tolerance ? 1.0 : 0.0;
    float too_far = clamp(in_front(r, surface, r.distance_m) / table.range - 1.0, 0.0, 1.0);
    return mix(open, NEUTRAL, too_far);
}

float screen_ao_visibility(screen_point receiver)
{
    screen_sphere sphere = screen_sphere_at(receiver.pixel, receiver.depth, view.radius_m);
    screen_plane plane = screen_plane_of(sphere, receiver.n);
    mat3 turn = screen_reflection_of_ball(receiver.pattern);
    ssao_receiver r;
    r.pixel = receiver.pixel;
    r.distance_m = screen_distance(receiver.depth);
    r.radius_m = sphere.radius_px / screen_pixels_per_m(view.scale, receiver.depth);
    r.focal_px = view.focal_px;
    r.perspective = view.perspective;
    r.distance_of_depth = view.distance_of_depth;
    float sum = 0.0;
    for (int i = 0; i < COUNT; i++) {
        vec3 point = turn * table.at[i].xyz;
        if (WITH_NORMAL) point -= 2.0 * min(dot(point, receiver.n), 0.0) * receiver.n;
        sum += table.at[i].w * visible(r, sphere, plane, point);
    }
    return mix(NEUTRAL, sum, screen_fade(sphere));
}
