// Shadow test with sharp edges, without an offset of the receiver. Include after frame.glsl.
//
// A shadow map has the exact depths of surfaces at texel centres. Each of the four texels around
// the receiver is extrapolated to the receiver's position in the map, from the texel beyond it, and
// is one of three kinds there: an occluder above the receiver; its own surface; or a lower surface,
// which says nothing about the light that arrives. The receiver is in shadow if the occluders have
// more bilinear weight than its own surface. Planes thus never shadow themselves, whatever their
// angle; walls that rise beside the receiver are no occluders; objects in contact have no gap of
// light between them; and a receiver below an edge, which no texel shows, is in shadow. Between
// occluders and receiver the edge is a contour of bilinear weights (Lorensen & Cline 1987), exact
// to a fraction of a texel for straight edges.
#ifndef AG_FRAME_SHADOW_RESOLVED_GLSL
#define AG_FRAME_SHADOW_RESOLVED_GLSL

#include "frame/shadow/shadow_limits.glsl"
#include "frame/shadow/shadow_shared.h"

// A receiver in a map. Units of all three axes are texels; z points to the light.
struct shadow_receiver {
    vec3 position;
    vec3 normal, to_viewer; // not normalised
    float depth;            // texels per unit of stored depth
    float size;             // of the map
    int layer;
};

shadow_receiver shadow_receiver_in(shadow_face face, vec3 world, vec3 normal, vec3 to_viewer)
{
    vec4 clip = face.clip_from_world * vec4(world, 1.0);
    vec4 along = face.clip_from_world * vec4(normal, 0.0);
    float w = max(clip.w, 1e-6);
    vec3 ndc = clip.xyz / w;
    shadow_receiver r;
    r.depth = face.depth_texels * w;
    r.size = face.size;
    r.layer = face.layer;
    vec3 scale = vec3(vec2(0.5 * face.size), r.depth);
    r.position = vec3((ndc.xy * 0.5 + 0.5) * face.size - 0.5, ndc.z * r.depth);
    r.normal = (along.xyz - ndc * along.w) * scale;
    along = face.clip_from_world * vec4(to_viewer, 0.0);
    r.to_viewer = (along.xyz - ndc * along.w) * scale;
    return r;
}

// Whether a map contains the stencil of a receiver.
bool shadow_contains(vec3 position, float size)
{
    vec2 inside = abs(position.xy - 0.5 * size) + 3.0;
    return max(inside.x, inside.y) < 0.5 * size;
}

// Heights of the surfaces in 2×2 texels above the receiver, towards the light. corner: between the
// texels.
vec4 shadow_heights(sampler2DArray maps, shadow_receiver r, vec2 corner)
{
    return textureGather(maps, vec3(corner / r.size, float(r.layer))) * r.depth - r.position.z;
}

// The slope with the smallest magnitude: that of the receiver's own surface beside an edge.
float shadow_least(float a, float b, float c)
{
    float least = abs(a) < abs(b) ? a : b;
    return abs(c) < abs(least) ? c : least;
}

// 0 or 1. The stencil is 4×4 texels without its corners; the inner texels are in the order
// (0, 0), (1, 0), (0, 1), (1, 1). facing: false for surfaces that need no test.
float shadow_resolved(sampler2DArray maps, shadow_receiver r, bool facing)
{
    // Software drivers fetch for all pixels: without need, from texels in the cache.
    vec2 at = facing ? clamp(r.position.xy, 1.0, r.size - 3.0) : vec2(1.0);
    vec2 first = floor(at), f = at - first;
    vec4 a = shadow_heights(maps, r, first), b = shadow_heights(maps, r, first + vec2(2, 0));
    vec4 c = shadow_heights(maps, r, first + vec2(0, 2)), d = shadow_heights(maps, r, first + 2.0);
    vec4 inner = vec4(a.y, b.x, c.z, d.w);
    vec4 rise_x = vec4(a.x, b.y, c.w, d.z) - inner; // away from the receiver
    vec4 rise_y = vec4(a.z, b.w, c.y, d.x) - inner;
    vec4 x = vec4(f.x, 1.0 - f.x, f.x, 1.0 - f.x), y = vec4(f.yy, 1.0 - f.yy); // distances
    vec4 weight = x.yxyx * y.zwxy;

    // The slope of the surface in the map and its normal.
    vec2 left = mix(vec2(-rise_x.x, -rise_y.x), vec2(-rise_x.z, -rise_y.y), f.yx);
    vec2 right = mix(vec2(rise_x.y, rise_y.z), vec2(rise_x.w, rise_y.w), f.yx);
    vec2 middle = mix(vec2(inner.y, inner.z) - inner.x, inner.w - vec2(inner.z, inner.y), f.yx);
    vec2 slope =
        vec2(shadow_least(left.x, middle.x, right.x), shadow_least(left.y, middle.y, right.y));
    vec3 normal = vec3(-slope, 1.0);
    float cosine = dot(normal, r.normal) *
                   inversesqrt(dot(normal, normal) * max(dot(r.normal, r.normal), 1e-20));
    float loose = cosine > SHADOW_PARALLEL ? SHADOW_SLOPE_TOLERANCE : 0.0;
    // Steeper than the surface between the inner texels is another surface.
    vec4 steepest_x = 1.0 + 2.0 * abs(inner.yyww - inner.xxzz);
    vec4 steepest_y = 1.0 + 2.0 * abs(inner.zwzw - inner.xyxy);
    vec4 slope_x = clamp(rise_x, -steepest_x, steepest_x);
    vec4 slope_y = clamp(rise_y, -steepest_y, steepest_y);
    vec4 tolerance = SHADOW_TOLERANCE + loose * (abs(slope_x) + abs(slope_y));
    vec4 least = inner - max(slope_x, 0.0) * x - max(slope_y, 0.0) * y;
    vec4 most = inner - min(slope_x, 0.0) * x - min(slope_y, 0.0) * y;
    // At a seam, the receiver is within the tolerance of the sheet above it: the viewer sees that
    // sheet's other side, and nothing of the receiver's own surface is in the map.
    vec4 across = r.to_viewer.x * slope_x * vec4(-1.0, 1.0, -1.0, 1.0) +
                  r.to_viewer.y * slope_y * vec4(-1.0, -1.0, 1.0, 1.0);
    vec4 away = vec4(lessThan(vec4(r.to_viewer.z) - across, vec4(0.0)));
    vec4 within = weight * vec4(greaterThanEqual(most, -tolerance));
    if (dot(within, vec4(1.0) - away) <= 0.0) tolerance *= vec4(1.0) - 2.0 * away;
    vec4 occluder = weight * vec4(greaterThan(least, tolerance));
    vec4 own = within - occluder;
    vec4 one = vec4(1.0);
    // Convex edges: the facet beyond the edge, extrapolated, is above the receiver, but the chord
    // between both facets is below.
    bool occluded =
        dot(occluder, one) > dot(own, one) && dot(occluder + own, inner - tolerance) > 0.0;

    return occluded ? 0.0 : 1.0;
}

#endif
