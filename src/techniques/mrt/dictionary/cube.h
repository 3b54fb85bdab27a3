// The unit cube [−½, ½]³ of the block dictionary (Loos 2015, sections 3.5.1 and 4.1): frames of its
// faces, its texels, and rays from points inside. Lengths are in edges of the cube.
#pragma once

#include "core/vec.h"

enum { CUBE_FACES = 6, CUBE_ALL_FACES = 63 };

// Faces are numbered −x, +x, −y, +y, −z, +z.
enum cube_face { CUBE_LEFT, CUBE_RIGHT, CUBE_BOTTOM, CUBE_TOP, CUBE_BACK, CUBE_FRONT };

static inline int cube_opposite(int face)
{
    return face ^ 1;
}

// Rotation from the frame of a face to the cube: columns u, v, n with n outward and u × v = n. v is
// +y, or +z on the bottom and top: the frame of a face, rotated by 180° around v, is that of
// the opposite face, so connected blocks agree on the frame of their interface.
mat3s cube_from_face(int face);

// Coordinates on a face: s along u and t along v, both in [0, 1].
vec3s cube_face_point(int face, float s, float t);

// The point where a ray leaves the cube. `from` is inside or on the surface; `direction` has any
// length.
struct cube_exit {
    int face;
    float s, t;
    float distance; // in lengths of the direction
};
struct cube_exit cube_trace(vec3s from, vec3s direction);
