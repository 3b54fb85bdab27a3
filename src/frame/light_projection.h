// Projections of shadow maps and reflective shadow maps: orthographic for suns, perspective for
// points and spots.
#pragma once

#include "scene/pose.h"

// Light space of a sun: a rotation whose −z axis is the light's direction. Deterministic.
mat4s light_space(vec3s direction);
// A square of half-width half_m around the light-space point (x, y), with the depth range of
// `bounds` (world space). depth_m: distance between depth 1 and depth 0.
mat4s light_orthographic(vec3s direction, float x, float y, float half_m, struct box3 bounds,
                         float *depth_m);
// One face of a point light's cube (0…5), or a spot's map.
mat4s light_cube_face(vec3s position, int face, float tan_half, float near_m);
mat4s light_spot_face(vec3s position, vec3s direction, float tan_half, float near_m);
// Tangent of a spot's half-angle, clamped to 85°.
float light_spot_tan(float cos_outer);
// Near plane of point and spot maps in a scene of this size.
float light_near(struct box3 bounds);
// Length of a box's diagonal, m; 0 if it is empty.
float light_diagonal(struct box3 bounds);
