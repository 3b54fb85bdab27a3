// Places in tubes: dictionary/tube.h. Needs MRT_BLOCKS_BINDING.
#ifndef AG_MRT_TUBE_GLSL
#define AG_MRT_TUBE_GLSL

#include "core/math.glsl"
#include "techniques/mrt/gpu/level.glsl"

layout(constant_id = MRT_CONSTANT_TUBES) const bool TUBES = false;

const float MRT_TUBE_RADIUS = 0.375;

struct mrt_tube_place {
    vec2 off;     // from the axis: to the left and up
    float around; // 0 to 1, from left through up
    float along;  // 0 to 1
    mat3 frame;   // forward, around and inward, in the cell
};

float angle_of(float y, float x)
{
    return x == 0.0 && y == 0.0 ? 0.0 : atan(y, x);
}

mrt_tube_place tube_place(int block, vec3 cell)
{
    int bend = block_table[block].bend;
    mrt_tube_place place;
    vec3 left = vec3(1.0, 0.0, 0.0), forward = vec3(0.0, 0.0, 1.0);
    place.off = cell.xy;
    place.along = cell.z + 0.5;
    if (bend > 0) {
        float side = bend == 1 ? 1.0 : -1.0;
        vec2 arm = vec2(0.5 - side * cell.x, cell.z + 0.5);
        float angle = angle_of(arm.y, arm.x);
        place.off.x = side * (0.5 - length(arm));
        place.along = angle / (0.5 * PI);
        left = vec3(cos(angle), 0.0, -side * sin(angle));
        forward = vec3(side * sin(angle), 0.0, cos(angle));
    }
    float angle = angle_of(place.off.y, place.off.x);
    vec3 inward = -cos(angle) * left - vec3(0.0, sin(angle), 0.0);
    place.around = fract(angle / (2.0 * PI));
    place.frame = mat3(forward, cross(inward, forward), inward);
    return place;
}

// The point of the square [0, 1]² that sample_disk of core/sampling.h takes to a point of the unit
// disk.
vec2 square_of_disk(vec2 disk)
{
    float radius = length(disk);
    bool wide = abs(disk.x) > abs(disk.y);
    vec2 major = wide ? disk : disk.yx;
    float ratio = major.x == 0.0 ? 0.0 : atan(major.y, abs(major.x)) / (0.25 * PI);
    float first = major.x < 0.0 ? -radius : radius;
    vec2 square = vec2(first, ratio * radius);
    return 0.5 + 0.5 * (wide ? square : square.yx);
}

// The place in [0, 1]³ of a tube's probes: across it and along.
vec3 tube_unit(int block, vec3 cell)
{
    mrt_tube_place place = tube_place(block, cell);
    return vec3(square_of_disk(place.off / MRT_TUBE_RADIUS), place.along);
}

#endif
