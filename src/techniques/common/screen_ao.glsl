// The sphere round a pixel's point, as a disk of lines through the depth buffer.
//
// Frame of a point P at the distance d along the view axis: the direction to it is w = (m, 1), m in
// units of the focal length, x right and y down. Perspective is undone by a projective map, which
// keeps planes plane: a point seen at the offset o pixels from P and at the distance dᵢ has the
// lateral position q = o d/f and the depth δ = d (1 − d/dᵢ); near P that is where it is, and the
// depth buffer's D = n/dᵢ is linear in δ, so no distance need be computed. A plane through P is
// exactly as far behind P on one side as it is before it on the other.
//
// The sphere of the radius R about P, to first order in R/d: with ℓ = |w| and B = I + m mᵀ/(ℓ + 1),
// which stretches along m by ℓ, the point s of the unit disk lies at q = R B s, the middle of its
// line at δ = −R (s·m)/ℓ, and half its length is R √(1 − s²)/ℓ. In radii along the line from its
// middle: z = ℓ δ/R + s·m.
#ifndef AG_SCREEN_AO_GLSL
#define AG_SCREEN_AO_GLSL

#define screen_ao screen_ao_data
#include "techniques/common/screen_ao_shared.h"
#undef screen_ao

#ifndef SCREEN_AO_BINDING
#define SCREEN_AO_BINDING 0
#endif

layout(set = 0, binding = SCREEN_AO_BINDING, scalar) uniform screen_ao
{
    screen_ao_params view;
};

layout(constant_id = SCREEN_AO_CONSTANT_STEP) const int SCREEN_AO_STEP = 1;

const float LEAST_PX = 0.01; // a radius of 0 has no disk
const float GRAZING = 0.05;  // cosine towards the eye, at least
const float NORMAL_STEP =
    1.0 / 1024.0; // of the G-buffer's 16-bit octahedral normals, as an angle, generously

struct screen_sphere {
    float depth;       // D at P
    vec2 m, bend;      // bend: m/(ℓ + 1)
    float l;           // ℓ
    float radius_px;   // at the picture's middle
    float z_per_depth; // of a difference of D: ℓ f / radius in pixels / D at P
};

// Of a sphere of the radius in metres about a point with the depth D, pixels.
float screen_radius_px(float radius_m, float depth)
{
    return clamp(radius_m * (view.focal_px / view.near_m) * depth, LEAST_PX, view.most_px);
}

screen_sphere screen_sphere_at(ivec2 pixel, float depth, float radius_m)
{
    screen_sphere p;
    p.depth = depth;
    p.m = (vec2(pixel) + 0.5 - vec2(view.middle_x, view.middle_y)) * (1.0 / view.focal_px);
    p.l = sqrt(1.0 + dot(p.m, p.m));
    p.bend = p.m / (p.l + 1.0);
    p.radius_px = screen_radius_px(radius_m, depth);
    p.z_per_depth = p.l * view.focal_px / (p.radius_px * depth);
    return p;
}

// B v
vec2 screen_stretch(screen_sphere p, vec2 v)
{
    return v + p.bend * dot(p.m, v);
}

// A surface through P: z of it is on_disk · s at the point s of the disk, and its part of z that
// comes from D at an offset in pixels is on_screen · offset.
struct screen_plane {
    vec2 on_disk, on_screen;
    float tolerance; // z, for what the normal is rounded by
};

// n: towards the eye; x right, y down, z away.
screen_plane screen_plane_of(screen_sphere p, vec3 n)
{
    float towards =
        min(dot(n, vec3(p.m, 1.0)), -GRAZING * p.l); // bounded: the slope grows without end
    float steep = p.l / towards;
    vec2 slope = n.xy * -steep;
    screen_plane plane;
    plane.on_disk = p.m + screen_stretch(p, slope);
    plane.on_screen = slope / p.radius_px;
    plane.tolerance = NORMAL_STEP * steep * steep;
    return plane;
}

// Depth of a surface behind the plane, z. It is measured where the pixel is that was looked at,
// `step` pixels away, so that rounding to pixels costs nothing on slopes; added to the plane's
// depth elsewhere it tells the surface's there.
float screen_behind(screen_sphere p, screen_plane plane, vec2 step, float depth)
{
    return p.z_per_depth * (p.depth - depth) - dot(plane.on_screen, step);
}

vec3 screen_normal(vec3 world)
{
    return vec3(dot(world, view.right), dot(world, view.down), dot(world, view.forward));
}

// Patterns repeat every 4 by 4 pixels, which the blur takes together; neighbours get numbers far
// apart (Bayer's matrix).
uint screen_pattern(uvec2 pixel)
{
    uint x = pixel.x ^ pixel.y;
    return (x & 1u) << 3 | (pixel.y & 1u) << 2 | (x & 2u) | (pixel.y & 2u) >> 1;
}

// In 0…1; golden steps, so that patterns of any symmetry are turned evenly.
float screen_turn(uint pattern)
{
    return fract(float(pattern) * 0.61803399 + view.turn);
}

// Reflects the disk about the direction at half the angle.
mat2 screen_reflection(uint pattern)
{
    float angle = 6.28318531 * screen_turn(pattern);
    float c = cos(angle), s = sin(angle);
    return mat2(c, s, s, -c);
}

// Reflects the ball about a direction; those of the patterns are spread evenly over the hemisphere.
mat3 screen_reflection_of_ball(uint pattern)
{
    float z = fract((float(pattern) + 0.5) / 16.0 + view.turn);
    float angle = 6.28318531 * screen_turn(pattern), r = sqrt(1.0 - z * z);
    vec3 about = vec3(r * cos(angle), r * sin(angle), z);
    return 2.0 * outerProduct(about, about) - mat3(1.0);
}

// Spheres of a pixel and less have nothing to show: they fade out before what they meet is chance.
float screen_fade(screen_sphere p)
{
    return clamp(p.radius_px - 1.0, 0.0, 1.0);
}

#endif
