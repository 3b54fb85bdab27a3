// The lookup of a receiver in the volumes of an object: its place, and the weight of each volume.
// Include after dnrt_object.glsl.
#ifndef DNRT_RECEIVER_GLSL
#define DNRT_RECEIVER_GLSL

layout(constant_id = 1) const uint NORMALS = 1;       // 1, 3 or 6 volumes, bake/transfer.h
layout(constant_id = 0) const bool QUADRATIC = false; // the grid

struct dnrt_receiver {
    vec3 position; // from the object's centre, along its axes, m
    vec3 normal;   // along its axes
};

dnrt_receiver dnrt_receiver_of(dnrt_gpu_object object, vec3 position, vec3 normal)
{
    return dnrt_receiver(dnrt_object_from_world(object, position - object.centre),
                         dnrt_object_from_world(object, normal));
}

// The normal whose product with the vector irradiance is the irradiance from above the horizon. An
// object is above with `part` of its extent along the normal, that of its bounding box within its
// bounding sphere: all of it counts, or of a sphere of this extent the cosine from above, part²
// h/d, is that of its form factor (a quadratic fit of Snyder 1996, "Area Light Sources for
// Real-Time Graphics").
vec3 dnrt_above_horizon(dnrt_gpu_object object, dnrt_receiver at, float radius)
{
    vec3 to_box = object.box_centre - at.position;
    float height = dot(to_box, at.normal), extent = dot(abs(at.normal), object.box_half);
    float of_centre = -dot(at.position, at.normal);
    float top = min(height + extent, of_centre + radius);
    float bottom = max(height - extent, of_centre - radius);
    float most = max(0.5 * (top - bottom), 1e-12);
    float part = clamp(0.25 * (top + bottom) / most + 0.5, 0.0, 1.0);
    float distance = max(length(to_box), 1e-12);
    float below = (1.0 - part) * min(most / distance, 1.0) / distance;
    return part * (at.normal + below * to_box);
}

// Weights of the volumes of x, y and z, or of x, −x, y, −y, z and −z: differences of two are the
// vector irradiance. Near an axis that of the axis alone, which has its own horizon, counts more.
float dnrt_weight(dnrt_receiver at, vec3 above, uint volume)
{
    if (NORMALS == 3u) return above[volume];
    uint axis = volume / 2u;
    float side = volume % 2u == 0u ? 1.0 : -1.0;
    vec3 square = at.normal * at.normal;
    float alone = dot(square, square); // 1 at an axis, 1/2 between two
    alone *= alone;
    alone *= alone;
    alone *= alone;
    float of_axis = side * at.normal[axis] > 0.0 ? square[axis] : 0.0;
    return mix(side * above[axis], of_axis, alone);
}

// The place of a lookup in a volume.
struct dnrt_place {
    vec3 at;     // among the samples, 0 to size − 1 along each edge
    float reach; // a factor: 1 in the inner volume, 0 out of the object's reach
};

// The outer volume is between the border of the inner one, at 1, and `fade`. A lookup there is the
// sample at the border times the inverse square of the distance, less its value at the end.
dnrt_place dnrt_place_of(dnrt_gpu_object object, dnrt_receiver at, uint size, float fade)
{
    vec3 p = at.position * (1.0 / object.half_m), extent = abs(p);
    float border = max(extent.x, max(extent.y, extent.z)), over = 1.0 / max(border, 1.0);
    float end = 1.0 / (fade * fade), fall = max((over * over - end) / (1.0 - end), 0.0);
    p *= over;
    if (QUADRATIC) p = sign(p) * sqrt(abs(p));
    dnrt_place place = dnrt_place((0.5 * p + 0.5) * float(size - 1u), border <= 1.0 ? 1.0 : fall);
    if (object.shape < 0 || border >= max(fade, 1.0)) place.reach = 0.0;
    return place;
}

#endif
