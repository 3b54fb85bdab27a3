// Shared by the estimators of volumetric obscurance. A shader includes this file and defines
// vo_visibility.
//
// Depths are in radii along a line of sight, z as in screen_ao.glsl. With the normal only the
// volume in front of the tangent plane counts; the visible part is divided by it, so that a plane
// has full visibility.
#include "techniques/common/screen_ao_estimate.glsl"
#include "techniques/vo/vo_shared.h"

layout(constant_id = VO_CONSTANT_COUNT) const int COUNT = 4;
layout(constant_id = VO_CONSTANT_NORMAL) const bool WITH_NORMAL = true;
layout(constant_id = VO_CONSTANT_TWO_RADII) const bool TWO_RADII = false;

layout(set = 0, binding = 4, scalar) uniform vo_table
{
    vo_samples table;
};

struct vo_point {
    ivec2 pixel;
    uint pattern; // index of the pixel's rotated sample set
    screen_sphere sphere;
    screen_plane plane;
    float thickness; // radii along a line
};

float vo_visibility(vo_point p);

// Open length of a line from `from` to `to` with a surface at z; behind the surface's thickness it
// is open again.
float vo_open(float z, float from, float to, float thickness)
{
    float before = clamp(z, from, to);
    return before - from + to - clamp(z + thickness, before, to);
}

// Depth of the surface at an offset in pixels behind the tangent plane. Outside the image the depth
// of its border continues parallel to the plane.
float vo_behind(vo_point p, vec2 offset)
{
    vec2 first = -vec2(p.pixel), last = vec2(view.width, view.height) - 1.0 + first;
    vec2 step = clamp(roundEven(offset), first, last);
    float behind =
        screen_behind(p.sphere, p.plane, step, texelFetch(depth, p.pixel + ivec2(step), 0).r);
    return WITH_NORMAL ? min(behind + p.plane.tolerance, 0.0) : behind;
}

float vo_of_radius(screen_point point, float radius_m)
{
    vo_point p;
    p.pixel = point.pixel;
    p.pattern = point.pattern;
    p.sphere = screen_sphere_at(point.pixel, point.depth, radius_m);
    p.plane = screen_plane_of(p.sphere, point.n);
    // Without the normal the thickness is measured across the surface, not along the line, so that
    // the tangent plane closes its half of the sphere.
    p.thickness =
        table.thickness * (WITH_NORMAL ? 1.0 : sqrt(1.0 + dot(p.plane.on_disk, p.plane.on_disk)));
    return mix(WITH_NORMAL ? 1.0 : 0.5, vo_visibility(p), screen_fade(p.sphere));
}

float screen_ao_visibility(screen_point point)
{
    float first = vo_of_radius(point, table.radii_m.x);
    return TWO_RADII ? 0.5 * (first + vo_of_radius(point, table.radii_m.y)) : first;
}
