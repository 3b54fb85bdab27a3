// Surfaces of the previous frame: whether a history pixel shows the surface of a pixel now. Its
// weight falls with its distance from the plane of the reprojected surface and with the difference
// of normals. Declare `set`, a vct_history_params, and the sampler `last_surface` (distance along
// the view axis, 0: none; packed normal) first.
#ifndef AG_VCT_HISTORY_GLSL
#define AG_VCT_HISTORY_GLSL

#include "techniques/vct/cones/packed_normal.glsl"

const float HISTORY_TOLERANCE_PX = 4.0; // distance from the plane, in pixel widths at that depth
const float HISTORY_LEAST = 0.1; // sum of the four tap weights below which history is rejected

// Size of the image plane at a distance, in units of vct_history_params.
float previous_scale(float distance_m)
{
    return mix(1.0, distance_m, set.perspective);
}

// Point relative to the previous camera.
vec3 previous_point(vec2 pixel, float distance_m)
{
    return distance_m * set.forward +
           previous_scale(distance_m) * (set.corner + pixel.x * set.right + pixel.y * set.down);
}

// A pixel's surface in the previous frame: its point relative to the camera, and 1 over the
// tolerance in m.
vec4 history_expected(vec2 history_pixel, float distance_m)
{
    return vec4(previous_point(history_pixel, distance_m),
                1.0 / (HISTORY_TOLERANCE_PX * set.pixel * previous_scale(distance_m)));
}

// Weight of the i-th of the four pixels around a position (common/reproject.glsl).
float history_weight(vec2 history_pixel, int i, vec4 expected, vec3 n)
{
    ivec2 at = reproject_tap(history_pixel, i);
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(frame.width, frame.height))))
        return 0.0;
    vec2 stored = texelFetch(last_surface, at, 0).rg;
    if (stored.x <= 0.0) return 0.0;
    vec3 stored_normal = unpacked_normal(stored.y);
    float plane_distance_m =
        abs(dot(stored_normal, previous_point(vec2(at), stored.x) - expected.xyz));
    return reproject_share(history_pixel, i) * max(1.0 - plane_distance_m * expected.w, 0.0) *
           normal_similarity(n, stored_normal);
}

#endif
