// Cosine-weighted visibility by slices: planes through the line of sight at equal angles about it.
//
// With V the unit vector from the point P to the camera and T a unit vector perpendicular to it, a
// slice has the directions ω = V cos θ + T sin θ, and
//     1/π ∫ v(ω) (n·ω)⁺ dω = 1/π ∫ dφ ∫ v (n_V cos θ + n_T sin θ)⁺ |sin θ| dθ,
// n_V = n·V, n_T = n·T, φ from 0 to π, θ from −π to π. On the side θ ≥ 0 the tangent plane is at
// tan t = −n_V/n_T, and the integral from V to the angle h is
//     F(h) = ½ (n_V sin²h + n_T (h − sin h cos h)).
// Its other side is the same with −T. Cosines have no unit, F neither.
//
// A horizon at the angle h occludes the directions from h to t, which have F(t) − F(h). Samples are
// visited by rising distance on the screen. Each adds what it occludes beyond those before it,
// weighted with the falloff at its own distance.
//
// With bitmasks a surface occludes from its front to its back, `thickness` behind it. Sector k of
// the 32 of a side has the directions with k ≤ 32 F/F(t) < k + 1: all sectors have the same
// cosine-weighted share, so that counting them integrates.
//
// The sum over slices is divided by Σ F(t) instead of their number: few slices then leave a plane
// open.
//
// Positions are relative to P, in radii of the sphere; axes are x right, y down, z forward.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/screen_ao_estimate.glsl"
#include "techniques/gtao/gtao_shared.h"

layout(constant_id = GTAO_CONSTANT_BITMASK) const bool BITMASK = false;
layout(constant_id = GTAO_CONSTANT_FALLOFF) const bool FALLOFF = false;

layout(set = 0, binding = 4, scalar) uniform gtao_table
{
    gtao_params table;
};

const float PI = 3.14159265;
const float SMALLEST_FALLOFF = 1.0e-6; // radii
const float LEAST_COSINE = 1.0e-3;     // of normal and line of sight
const float SECTORS = 32.0;
const float FAR_RADII = 1.0e6; // at which sight lines are parallel

struct gtao_point {
    ivec2 pixel;
    float depth;     // D
    vec3 n;          // unit
    vec3 to_camera;  // V
    float distance;  // from the camera, in radii; large in orthographic views
    float per_depth; // radii per difference of D, in orthographic views
    float thickness; // of occluders, in radii
};

// Positions in the slice have components along V and T.
struct gtao_side {
    vec2 n;       // of the normal
    vec2 tangent; // cos t, sin t
    float whole;  // F(t)
    vec2 pixels;  // offset of T times the radius
    mat2 moved; // position at an offset of one pixel, in the plane through P that faces the camera
};

// F at the direction (cos h, sin h).
float cosine_up_to(vec2 direction, vec2 n)
{
    float h = acos(clamp(direction.x, -1.0, 1.0));
    return 0.5 * (n.x * direction.y * direction.y + n.y * (h - direction.x * direction.y));
}

// A unit vector perpendicular to the line of sight; s: unit, in the image at its center. It is the
// rotation of (s, 0) that takes the view axis to (m, 1).
vec3 perpendicular(screen_sphere sphere, vec2 s)
{
    float along = dot(sphere.m, s) / sphere.l;
    return vec3(s - sphere.bend * along, -along);
}

// With k the ratio of distances to a surface and to P, along the view axis, and o its offset in
// pixels, its position is v = (m (k − 1) + k o/f, k − 1) f/radius_px. As (m, 1) is −ℓ V, its
// components are v·V = (ℓ (1 − k) + k o·V/f) f/radius_px and v·T = k o·T/radius_px. Pixel centers
// are beside the slice: v is moved into it parallel to the tangent plane, by its component across
// times lean (n_V, n_T), so that n·v is the same. In orthographic views m = 0 and k = 1, and v·V is
// the difference of the distances.
gtao_side side_of(gtao_point p, screen_sphere sphere, vec2 s)
{
    gtao_side side;
    vec3 along = perpendicular(sphere, s), across = cross(p.to_camera, along);
    side.n = vec2(dot(p.n, p.to_camera), dot(p.n, along));
    float squared = dot(side.n, side.n), lean = dot(p.n, across) / squared;
    side.tangent = vec2(-side.n.y, side.n.x) * inversesqrt(squared);
    side.whole = max(cosine_up_to(side.tangent, side.n), 1.0e-9);
    side.pixels = screen_stretch(sphere, s) * sphere.radius_px;
    vec2 along_v = p.to_camera.xy + lean * side.n.x * across.xy;
    vec2 along_t = along.xy + lean * side.n.y * across.xy;
    side.moved = mat2(along_v.x, along_t.x, along_v.y, along_t.y) * (1.0 / sphere.radius_px);
    return side;
}

// The surface at a part of the radius on the screen; P where there is none. false: beyond the
// border.
bool surface_at(gtao_point p, gtao_side side, float reach, out vec2 front)
{
    ivec2 offset = ivec2(round(side.pixels * reach)), pixel = p.pixel + offset;
    front = vec2(0.0);
    if (any(lessThan(pixel, ivec2(0))) ||
        any(greaterThanEqual(pixel, ivec2(view.width, view.height))))
        return false;
    float there = texelFetch(depth, pixel, 0).r;
    bool perspective = view.perspective != 0.0;
    float ratio = perspective ? p.depth / there : 1.0;
    // Exactly 0 at P itself, where 1 - ratio would be the rounding error of a division.
    float nearer = (there - p.depth) * (perspective ? p.distance / there : p.per_depth);
    if (there > 0.0) front = vec2(nearer, 0.0) + ratio * (side.moved * vec2(offset));
    return true;
}

bool is_above_plane(gtao_side side, vec2 front)
{
    return dot(side.n, front) > NORMAL_STEP * length(front);
}

vec2 direction_to(vec2 v)
{
    v.y = max(v.y, 0.0);
    return v * inversesqrt(max(dot(v, v), 1.0e-30));
}

uint sectors_up_to(float share, float dither)
{
    int count = clamp(int(ceil(share * SECTORS - dither)), 0, int(SECTORS));
    return count >= 32 ? 0xffffffffu : (1u << count) - 1u;
}

// Directions that samples of a side occlude.
struct gtao_occluded {
    float highest; // horizon: its cosine,
    float open;    // and F up to it
    uint sectors;
};

// Adds the directions below a surface; returns their part of F(t).
float occlude_below(inout gtao_occluded occluded, gtao_side side, vec2 front)
{
    vec2 direction = direction_to(front);
    if (direction.x <= occluded.highest) return 0.0;
    float before = occluded.open;
    occluded.highest = direction.x;
    occluded.open = cosine_up_to(direction, side.n);
    return before - occluded.open;
}

// Adds the sectors between a surface's front and its back; returns their part of F(t).
float occlude_behind(inout gtao_occluded occluded, gtao_point p, gtao_side side, vec2 front,
                     float dither)
{
    vec2 away = normalize(front - vec2(p.distance, 0.0)); // from the camera to the front
    vec2 back = front + p.thickness * away;
    float first = cosine_up_to(direction_to(front), side.n) / side.whole;
    float last =
        dot(back, side.n) <= 0.0 ? 1.0 : cosine_up_to(direction_to(back), side.n) / side.whole;
    uint fresh = sectors_up_to(last, dither) & ~sectors_up_to(first, dither) & ~occluded.sectors;
    occluded.sectors |= fresh;
    return side.whole * float(bitCount(fresh)) / SECTORS;
}

// Occluded part of F(t).
float occlusion(gtao_point p, gtao_side side, float jitter)
{
    gtao_occluded occluded = gtao_occluded(side.tangent.x, side.whole, 0u);
    float sum = 0.0;
    vec2 front;
    for (int i = 0; i < table.steps; i++) {
        if (!surface_at(p, side, (float(i) + jitter) / float(table.steps), front)) break;
        float weight = (1.0 - length(front)) / max(table.falloff, SMALLEST_FALLOFF);
        if (weight <= 0.0 || !is_above_plane(side, front)) continue;
        float part = BITMASK ? occlude_behind(occluded, p, side, front, jitter)
                             : occlude_below(occluded, side, front);
        sum += min(weight, 1.0) * part;
    }
    return sum;
}

// The same for horizons without falloff, whose parts add up: F of the last one suffices.
float occlusion_within_radius(gtao_point p, gtao_side side, float jitter)
{
    vec2 horizon = side.tangent, front;
    for (int i = 0; i < table.steps; i++) {
        if (!surface_at(p, side, (float(i) + jitter) / float(table.steps), front)) break;
        vec2 direction = direction_to(front);
        if (dot(front, front) < 1.0 && is_above_plane(side, front) && direction.x > horizon.x)
            horizon = direction;
    }
    return horizon == side.tangent ? 0.0 : side.whole - cosine_up_to(horizon, side.n);
}

gtao_point point_of(screen_point at, screen_sphere sphere)
{
    gtao_point p;
    p.pixel = at.pixel;
    p.depth = at.depth;
    p.to_camera = vec3(sphere.m, 1.0) / -sphere.l;
    float cosine = dot(at.n, p.to_camera);
    p.n = normalize(at.n + p.to_camera * max(LEAST_COSINE - cosine, 0.0));
    // A distance along the view axis is focal_px / radius_px radii.
    p.distance = view.perspective != 0.0 ? sphere.l * view.focal_px / sphere.radius_px : FAR_RADII;
    p.per_depth = sphere.z_per_depth;
    p.thickness = table.thickness_m * screen_pixels_per_m(view.scale, at.depth) / sphere.radius_px;
    return p;
}

float screen_ao_visibility(screen_point at)
{
    screen_sphere sphere = screen_sphere_at(at.pixel, at.depth, view.radius_m);
    gtao_point p = point_of(at, sphere);
    float rotation = screen_rotation(at.pattern);
    float jitter = screen_jitter(at.pattern);
    float occluded = 0.0, whole = 0.0;
    for (int i = 0; i < 2 * table.slices; i++) {
        float angle = PI * (float(i) + rotation) / float(table.slices);
        gtao_side side = side_of(p, sphere, vec2(cos(angle), sin(angle)));
        occluded += BITMASK || FALLOFF ? occlusion(p, side, jitter)
                                       : occlusion_within_radius(p, side, jitter);
        whole += side.whole;
    }
    return mix(1.0, 1.0 - occluded / whole, screen_fade(sphere));
}
