// The cylinders of the tunnel dictionary (Loos 2015, section 3.6.1): a round tube through the unit
// cell [−½, ½]³, straight from −z to +z, or bent by a quarter circle from −z to +x (left along the
// way, y being up) or −x (right). Lengths are in edges of the cell.
#pragma once

#include "core/vec.h"

static const float TUBE_RADIUS = 0.375f; // that of @tunnel; bends have their axis at ½

enum tube_bend { TUBE_STRAIGHT, TUBE_LEFT, TUBE_RIGHT };

// A frame on the axis: x to the left, y up, z along the way; `along` in [0, 1].
struct tube_frame {
    vec3s origin, left, forward;
};
struct tube_frame tube_axis(enum tube_bend bend, float along);

// The point of the wall at coordinates of struct tube_place.
vec3s tube_wall(enum tube_bend bend, float around, float along);

// A point of the cell in the coordinates of the tube: `around` in [0, 1) from left through up, the
// distance from the axis, and `along`.
struct tube_place {
    float around, radius, along;
};
struct tube_place tube_locate(enum tube_bend bend, vec3s point);

// The point at (x, y, z) of the unit cube: (x, y) is mapped to the disk, z is along the tube.
vec3s tube_inside(enum tube_bend bend, vec3s unit);

// The distance (in lengths of `direction`, a unit vector) to the wall, or to an end of the tube.
enum tube_exit { TUBE_WALL, TUBE_BEGIN, TUBE_END };
enum tube_exit tube_trace(enum tube_bend bend, vec3s from, vec3s direction, float *distance);
