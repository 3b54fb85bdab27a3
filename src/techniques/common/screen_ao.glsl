// The sphere around a pixel's surface point P, parameterized as a disk of lines of sight.
//
// Local frame: P is at the distance d along the view axis; the direction to it is w = (m, 1), m in
// units of the focal length, x right and y down. A projective map undoes the perspective and maps
// planes to planes: a point at the offset o pixels from P and the distance dᵢ has the lateral
// position q = o d/f and the depth δ = d (1 − d/dᵢ), which is exact to first order near P. The
// depth buffer's D = n/dᵢ is linear in δ, so no distance is computed. In orthographic views m = 0
// and δ = dᵢ − d, in which D is linear, too.
//
// The sphere of radius R around P, to first order in R/d: with ℓ = |w| and B = I + m mᵀ/(ℓ + 1),
// which stretches along m by ℓ, the point s of the unit disk lies at q = R B s, the midpoint of its
// chord at δ = −R (s·m)/ℓ, and half the chord's length is R √(1 − s²)/ℓ. In radii along the chord
// from its midpoint: z = ℓ δ/R + s·m.
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

const float MIN_RADIUS_PX = 0.01; // a radius of 0 has no disk
const float GRAZING = 0.05;       // smallest cosine of normal and view direction
// Bound on the quantization error of the G-buffer's 16-bit octahedral normals, radians.
const float NORMAL_STEP = 1.0 / 1024.0;

struct screen_sphere {
    float depth;       // D at P
    vec2 m, bend;      // bend: m/(ℓ + 1)
    float l;           // ℓ
    float radius_px;   // at the image center
    float z_per_depth; // z per difference of D: ℓ f / (radius in pixels · D at P) in perspective
};

// See scale of struct screen_ao_params.
float screen_pixels_per_m(vec4 scale, float depth)
{
    return scale.x + scale.y * depth;
}

// Radii of δ per difference of D at the depth D.
float screen_radii_per_depth(vec4 scale, float radius_px, float depth)
{
    return (scale.z * depth + scale.w) / (radius_px * depth);
}

// Radius in pixels of a sphere around a point with the depth buffer value D.
float screen_radius_px(float radius_m, float depth)
{
    return clamp(radius_m * screen_pixels_per_m(view.scale, depth), MIN_RADIUS_PX,
                 view.max_radius_px);
}

// Metres along the view axis.
float screen_distance(float depth)
{
    vec4 m = view.distance_of_depth;
    return (m.x + m.y * depth) / (m.z + m.w * depth);
}

screen_sphere screen_sphere_at(ivec2 pixel, float depth, float radius_m)
{
    screen_sphere p;
    p.depth = depth;
    p.m = (vec2(pixel) + 0.5 - vec2(view.center_x, view.center_y)) *
          (view.perspective / view.focal_px);
    p.l = sqrt(1.0 + dot(p.m, p.m));
    p.bend = p.m / (p.l + 1.0);
    p.radius_px = screen_radius_px(radius_m, depth);
    p.z_per_depth = p.l * screen_radii_per_depth(view.scale, p.radius_px, depth);
    return p;
}

// B v
vec2 screen_stretch(screen_sphere p, vec2 v)
{
    return v + p.bend * dot(p.m, v);
}

// A plane through P: z = on_disk · s at the point s of the disk; on_screen · offset is the part of
// z that D contributes at an offset in pixels.
struct screen_plane {
    vec2 on_disk, on_screen;
    float tolerance; // z, for the normal's quantization
};

// n faces the camera; x right, y down, z forward.
screen_plane screen_plane_of(screen_sphere p, vec3 n)
{
    float towards = min(dot(n, vec3(p.m, 1.0)), -GRAZING * p.l); // bounds the slope
    float steep = p.l / towards;
    vec2 slope = n.xy * -steep;
    screen_plane plane;
    plane.on_disk = p.m + screen_stretch(p, slope);
    plane.on_screen = slope / p.radius_px;
    plane.tolerance = NORMAL_STEP * steep * steep;
    return plane;
}

// Depth z of a surface behind the plane, at the center of the fetched pixel, `step` pixels away.
// Relative to the plane, rounding to pixel centers causes no error on slopes.
float screen_behind(screen_sphere p, screen_plane plane, vec2 step, float depth)
{
    return p.z_per_depth * (p.depth - depth) - dot(plane.on_screen, step);
}

vec3 screen_normal(vec3 world)
{
    return vec3(dot(world, view.right), dot(world, view.down), dot(world, view.forward));
}

// Rotation of the pattern in 0…1: a golden-ratio sequence, uniform for any symmetry of the samples.
float screen_rotation(uint pattern)
{
    return fract(float(pattern) * 0.61803399 + view.rotation);
}

// Jitter of the first step in 0…1: 16 values, in another order than the rotations.
float screen_jitter(uint pattern)
{
    return (float((pattern * 5u) & 15u) + 0.5) / 16.0;
}

// Reflects the disk across the direction at half the angle.
mat2 screen_reflection(uint pattern)
{
    float angle = 6.28318531 * screen_rotation(pattern);
    float c = cos(angle), s = sin(angle);
    return mat2(c, s, s, -c);
}

// Reflects the ball across a direction; the patterns' directions are uniform over the hemisphere.
mat3 screen_reflection_of_ball(uint pattern)
{
    float z = fract((float(pattern) + 0.5) / 16.0 + view.rotation);
    float angle = 6.28318531 * screen_rotation(pattern), r = sqrt(1.0 - z * z);
    vec3 about = vec3(r * cos(angle), r * sin(angle), z);
    return 2.0 * outerProduct(about, about) - mat3(1.0);
}

// Fades out spheres below two pixels of radius, which are undersampled.
float screen_fade(screen_sphere p)
{
    return clamp(p.radius_px - 1.0, 0.0, 1.0);
}

#endif
