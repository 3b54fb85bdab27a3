// View and projection matrices. Vulkan clip space: x right, y down, depth reversed (1 near, 0 far).
#pragma once

#include "scene/pose.h"

// View space: x right, y up, looking along −z.
mat4s projection_view_from_world(vec3s eye, vec3s forward, vec3s up);
// Infinite far plane: depth = near_m / distance along the axis.
mat4s projection_perspective(float tan_half_x, float tan_half_y, float near_m);
// half_m: half the edge of the square in metres. Depth is 1 at near_m along the axis and 0 at
// far_m.
mat4s projection_orthographic(float half_m, float near_m, float far_m);

// The six faces of a cube map, +x −x +y −y +z −z.
vec3s projection_cube_forward(int face);
vec3s projection_cube_up(int face);

// The inverse, in double precision: reconstructed positions need its last digits.
mat4s projection_inverse(mat4s m);

// Conservative frustum culling: false only if the box is outside of the clip volume.
bool projection_may_see(mat4s clip_from_world, struct box3 box);
