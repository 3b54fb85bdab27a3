// Geometry of the unit cube.
#include "cube.h"

#include <math.h>

static vec3s axis_vector(int axis, float length)
{
    vec3s v = vec3_of(0, 0, 0);
    v.raw[axis] = length;
    return v;
}

mat3s cube_from_face(int face)
{
    int axis = face / 2;
    vec3s n = axis_vector(axis, face & 1 ? 1.0f : -1.0f);
    vec3s v = axis_vector(axis == 1 ? 2 : 1, 1.0f);
    return (mat3s){ .col = { glms_vec3_cross(v, n), v, n } };
}

vec3s cube_face_point(int face, float s, float t)
{
    return glms_mat3_mulv(cube_from_face(face), vec3_of(s - 0.5f, t - 0.5f, 0.5f));
}

// The axis of the nearest slab in the ray's direction, and the distance to it.
static int exit_axis(vec3s from, vec3s direction, float *distance)
{
    int axis = 0;
    *distance = INFINITY;
    for (int a = 0; a < 3; a++) {
        if (direction.raw[a] == 0.0f) continue;
        float d = (copysignf(0.5f, direction.raw[a]) - from.raw[a]) / direction.raw[a];
        if (d >= *distance) continue;
        *distance = d;
        axis = a;
    }
    return axis;
}

static float unit_clamp(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

struct cube_exit cube_trace(vec3s from, vec3s direction)
{
    float distance;
    int axis = exit_axis(from, direction, &distance);
    int face = 2 * axis + (direction.raw[axis] > 0.0f);
    vec3s p = glms_vec3_muladds(direction, distance, from);
    // The signs of u = v × n: y × x = −z, z × y = −x, y × z = x.
    float sign = axis == 2 ? 1.0f : -1.0f;
    if (!(face & 1)) sign = -sign;
    float u = sign * p.raw[axis == 0 ? 2 : 0], v = p.raw[axis == 1 ? 2 : 1];
    return (struct cube_exit){ face, unit_clamp(0.5f + u), unit_clamp(0.5f + v), distance };
}
