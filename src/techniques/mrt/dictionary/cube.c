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

// The distance to the plane ahead on one axis.
static float slab_distance(float from, float direction)
{
    return direction == 0.0f ? INFINITY : (copysignf(0.5f, direction) - from) / direction;
}

// Which slab is nearest is as random as the rays: it is selected by values, not by branches.
struct cube_exit cube_trace(vec3s from, vec3s direction)
{
    // Axes, and the sign of u = v × n by face: y × x = −z, z × y = −x, y × z = x.
    static const unsigned char U[] = { 2, 0, 0 }, V[] = { 1, 2, 1 };
    static const float SIGN[] = { 1.0f, -1.0f, 1.0f, -1.0f, -1.0f, 1.0f };
    const float x = slab_distance(from.x, direction.x), y = slab_distance(from.y, direction.y),
                z = slab_distance(from.z, direction.z);
    const float nearer = glm_min(y, x), distance = glm_min(z, nearer);
    const int axis = z < nearer ? 2 : y < x, a = U[axis], b = V[axis];
    const int face = 2 * axis + (direction.raw[axis] > 0.0f);
    const float u = SIGN[face] * (from.raw[a] + direction.raw[a] * distance),
                v = from.raw[b] + direction.raw[b] * distance;
    return (struct cube_exit){ face, glm_clamp(0.5f + u, 0.0f, 1.0f),
                               glm_clamp(0.5f + v, 0.0f, 1.0f), distance };
}
