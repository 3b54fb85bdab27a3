// What the ways to look into the sphere round a pixel's point have in common. A shader includes
// this file and says in vo_visibility how much it sees.
//
// Depths are in radii along a line of sight, z as in screen_ao.glsl. With the normal only what is
// before the surface's tangent plane counts, and what is visible is divided by all there is up to
// there, so that a plane is visible in full.
#include "techniques/common/screen_ao_estimate.glsl"
#include "techniques/vo/vo_shared.h"

layout(constant_id = VO_CONSTANT_COUNT) const int COUNT = 4;
layout(constant_id = VO_CONSTANT_NORMAL) const bool WITH_NORMAL = true;
layout(constant_id = VO_CONSTANT_TWO_RADII) const bool TWO_RADII = false;

layout(set = 0, binding = 4, scalar) uniform vo_table
{
    vo_samples table;
};

struct vo_place {
    ivec2 pixel;
    uint pattern; // which of the turned sets is this pixel's
    screen_sphere sphere;
    screen_plane plane;
    float thickness; // radii along a line
};

float vo_visibility(vo_place p);

// How much of a line from `from` to `to` is open beside a surface at z; what is behind that by more
// than the thickness is empty.
float vo_open(float z, float from, float to, float thickness)
{
    float before = clamp(z, from, to);
    return before - from + to - clamp(z + thickness, before, to);
}

// Depth behind the tangent plane of the surface at an offset in pixels. What lies beside the
// picture goes on as the plane from its edge on.
float vo_behind(vo_place p, vec2 offset)
{
    vec2 first = -vec2(p.pixel), last = vec2(view.width, view.height) - 1.0 + first;
    vec2 step = clamp(roundEven(offset), first, last);
    float behind =
        screen_behind(p.sphere, p.plane, step, texelFetch(depth, p.pixel + ivec2(step), 0).r);
    return WITH_NORMAL ? min(behind + p.plane.tolerance, 0.0) : behind;
}

float vo_of_radius(screen_place place, float radius_m)
{
    vo_place p;
    p.pixel = place.pixel;
    p.pattern = place.pattern;
    p.sphere = screen_sphere_at(place.pixel, place.depth, radius_m);
    p.plane = screen_plane_of(p.sphere, place.n);
    // Without the normal the surface's own plane must close its half of the sphere: its thickness
    // is across, not along lines.
    p.thickness =
        table.thickness * (WITH_NORMAL ? 1.0 : sqrt(1.0 + dot(p.plane.on_disk, p.plane.on_disk)));
    return mix(WITH_NORMAL ? 1.0 : 0.5, vo_visibility(p), screen_fade(p.sphere));
}

float screen_ao_visibility(screen_place place)
{
    float first = vo_of_radius(place, table.radii_m.x);
    return TWO_RADII ? 0.5 * (first + vo_of_radius(place, table.radii_m.y)) : first;
}
