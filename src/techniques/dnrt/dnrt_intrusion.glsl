// Occlusion between an object and a receiver, by the depth maps of the object. The light is the
// disk of its bounding sphere: percentage-closer soft shadows (Fernando 2005), with each occluder
// projected from the receiver to that disk.
//
// Texels are compared with the receiver's tangent plane, too: geometry behind the plane occludes
// none of the receiver's light, and a plane never occludes itself, however large the penumbra.
// Directions that end behind the plane before the occluders do not count: that part of the disk is
// below the horizon.

#include "core/basis.glsl"

const int SEARCH_TAPS = 16, FILTER_TAPS = 16;
const vec2 GOLDEN_TURN = vec2(-0.73736888, 0.67549029); // cosine and sine of π (3 − √5)
// Height over the tangent plane below which texels are not in front of it, over their distance from
// the receiver: covers the rounding of normals and the curvature of smooth surfaces.
const float PLANE_SLACK = 0.02;
// Lookups along the ray to the disk where a direction ends behind the tangent plane, each nearer to
// the axis: an occluder may be closer to the receiver than the others.
const int FOLLOW_STEPS = 2;
const float LEAST_TEXELS = 1.5; // radius of the filter
const float FARTHEST = 1.0;     // tangent of the widest search: occluders nearer than the sphere

layout(set = 0, binding = 8) uniform sampler2DArray depth_maps; // projection_cube_forward, …_up

struct intrusion {
    int map; // first layer
    float near_m;
    vec3 receiver; // relative to the object's centre, m
    vec3 normal;
    vec3 towards; // unit, from the centre to the receiver
    float distance;
    float radius;
};

// The point, relative to the centre, in the middle of the texel in this direction. Far away where
// nothing is.
vec3 intrusion_point(intrusion i, vec3 to)
{
    vec3 a = abs(to);
    bool on_x = a.x >= a.y && a.x >= a.z, on_y = !on_x && a.y >= a.z;
    float along = on_x ? to.x : on_y ? to.y : to.z;
    float side = along < 0.0 ? -1.0 : 1.0;
    vec2 at = on_x   ? vec2(side * to.z, -to.y)
              : on_y ? vec2(side * to.x, -to.z)
                     : vec2(-side * to.x, -to.y);
    int face = (on_x ? 0 : on_y ? 2 : 4) + (along < 0.0 ? 1 : 0);
    float size = float(push.map_size);
    vec2 texel = clamp(floor((at / abs(along) * 0.5 + 0.5) * size), vec2(0.0), vec2(size - 1.0));
    float depth = texelFetch(depth_maps, ivec3(texel, i.map + face), 0).r;
    vec2 middle = (texel + 0.5) * (2.0 / size) - 1.0;
    vec3 ray = on_x   ? vec3(side, -middle.y, side * middle.x)
               : on_y ? vec3(side * middle.x, side, -middle.y)
                      : vec3(-side * middle.x, -middle.y, side);
    return ray * (i.near_m / max(depth, 1e-20));
}

const float NOTHING = 0.0, HIDES = 1.0, BEHIND = 2.0;

// x: distance along the axis of the occluder in a direction; y: whether it is in front of the
// receiver's tangent plane (HIDES) or behind it (BEHIND). NOTHING: none is before the receiver.
vec2 intrusion_texel(intrusion i, vec3 to)
{
    vec3 point = intrusion_point(i, to), from_receiver = point - i.receiver;
    float z = dot(point, i.towards);
    if (!(z > 0.0 && z < i.distance)) return vec2(0.0, NOTHING);
    // Within a texel of the receiver the rounding of its position counts, too.
    float away = max(length(from_receiver), i.distance * (2.0 / float(push.map_size)));
    bool front = dot(from_receiver, i.normal) > PLANE_SLACK * away;
    return vec2(z, front ? HIDES : BEHIND);
}

vec2 next_turn(vec2 turn)
{
    return vec2(turn.x * GOLDEN_TURN.x - turn.y * GOLDEN_TURN.y,
                turn.x * GOLDEN_TURN.y + turn.y * GOLDEN_TURN.x);
}

// Part of the object that the receiver sees, 0…1. Behind an occluder at z the disk has a radius of
// R (1/z − 1/d), as a tangent at the centre.
float intrusion_visibility(intrusion i)
{
    vec3 a = perpendicular_to(i.towards), b = cross(i.towards, a);
    float texel = 2.0 / float(push.map_size), least = LEAST_TEXELS * texel;
    float far = 1.0 / i.distance;
    float widest = clamp(1.0 - i.radius * far, least, FARTHEST);
    float near = 0.0, found = 0.0; // sum of 1/z
    vec2 turn = vec2(1.0, 0.0);
    for (int k = 0; k < SEARCH_TAPS; k++) { // denser near the axis: occluders near the receiver
        float share = float(k) / float(SEARCH_TAPS - 1);
        float r = widest * share * share;
        vec2 at = intrusion_texel(i, i.towards + r * (turn.x * a + turn.y * b));
        if (at.y == HIDES && r <= 2.0 * i.radius * (1.0 / at.x - far) + texel) {
            near += 1.0 / at.x;
            found += 1.0;
        }
        turn = next_turn(turn);
    }
    if (found == 0.0) return 1.0;
    near /= found;
    float penumbra = clamp(i.radius * (near - far), least, widest), hidden = 0.0, below = 0.0;
    for (int k = 0; k < FILTER_TAPS; k++) {
        float share = sqrt((float(k) + 0.5) / float(FILTER_TAPS));
        vec3 side = turn.x * a + turn.y * b;
        vec2 at = intrusion_texel(i, i.towards + (penumbra * share) * side);
        bool is_below = at.y == BEHIND && at.x * near < 1.0;
        for (int n = 0; n < FOLLOW_STEPS && at.y == BEHIND && !is_below; n++) {
            float r = i.radius * (1.0 / at.x - far) * share;
            at = intrusion_texel(i, i.towards + r * side);
            if (1.0 / at.x - far > 0.75 * (near - far)) at.y = NOTHING; // before the ray
        }
        hidden += at.y == HIDES ? 1.0 : 0.0;
        below += is_below ? 1.0 : 0.0;
        turn = next_turn(turn);
    }
    return 1.0 - hidden / max(float(FILTER_TAPS) - below, 1.0);
}

// Visibility of object `index` from a receiver.
float visibility_of(uint index, dnrt_gpu_object object, vec3 position, vec3 n)
{
    vec3 receiver = position - object.centre;
    float distance = length(receiver), radius = object.half_m / push.reach;
    if (index >= push.map_count || distance == 0.0) return 1.0;
    return intrusion_visibility(intrusion(6 * int(index), float(DNRT_NEAR) * radius, receiver, n,
                                          receiver / distance, distance, radius));
}
