// One step: light goes from each cell into its six neighbours, gathered by the receiver (Martin 2012, sec. 3.2.3, 3.3).
//
// What accumulates over the steps is A = S + TS + T²S + …, S what was injected, T the step. T is linear (nothing is
// clamped), so the accumulation needs no pass and no third grid of its own: A' = S + T A. T as five numbers is
// struct lpv_step; test_lpv_twin holds it to the sum over faces.
//
// Included with LPV_FORMAT, the format of what is written.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler3D injected_red;
layout(set = 0, binding = 2) uniform sampler3D injected_green;
layout(set = 0, binding = 3) uniform sampler3D injected_blue;
layout(set = 0, binding = 4) uniform sampler3D before_red;
layout(set = 0, binding = 5) uniform sampler3D before_green;
layout(set = 0, binding = 6) uniform sampler3D before_blue;
layout(set = 0, binding = 7, LPV_FORMAT) uniform writeonly image3D after_red;
layout(set = 0, binding = 8, LPV_FORMAT) uniform writeonly image3D after_green;
layout(set = 0, binding = 9, LPV_FORMAT) uniform writeonly image3D after_blue;

// Coefficients are c0, cy, cz, cx. `up` came along +axis, `down` along −axis; `axis` selects the axis' component.
vec4 arriving(vec4 up, vec4 down, vec3 axis)
{
    vec4 sum = up + down, difference = up - down;
    float driven = lpv.keep * sum.x + lpv.drive * dot(difference.yzw, axis);
    vec3 turned = mix(vec3(lpv.across), vec3(lpv.along), axis) * sum.yzw;
    return vec4(driven, turned + lpv.aim * difference.x * axis);
}

#define LPV_GATHER(before, injected)                                                                         \
    (texelFetch(injected, cell, 0) +                                                                         \
     arriving(texelFetch(before, west, 0) * has_west, texelFetch(before, east, 0) * has_east, vec3(0, 0, 1)) + \
     arriving(texelFetch(before, under, 0) * has_under, texelFetch(before, over, 0) * has_over, vec3(1, 0, 0)) + \
     arriving(texelFetch(before, north, 0) * has_north, texelFetch(before, south, 0) * has_south, vec3(0, 1, 0)))

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    if (!lpv_inside(cell)) return;
    // Nothing comes from outside: the fetch is kept within the grid and weighted with 0.
    ivec3 end = lpv_cells() - 1;
    ivec3 low = max(cell - 1, ivec3(0)), high = min(cell + 1, end);
    ivec3 west = ivec3(low.x, cell.yz), east = ivec3(high.x, cell.yz);
    ivec3 under = ivec3(cell.x, low.y, cell.z), over = ivec3(cell.x, high.y, cell.z);
    ivec3 north = ivec3(cell.xy, low.z), south = ivec3(cell.xy, high.z);
    float has_west = float(cell.x > 0), has_east = float(cell.x < end.x);
    float has_under = float(cell.y > 0), has_over = float(cell.y < end.y);
    float has_north = float(cell.z > 0), has_south = float(cell.z < end.z);
    imageStore(after_red, cell, LPV_GATHER(before_red, injected_red));
    imageStore(after_green, cell, LPV_GATHER(before_green, injected_green));
    imageStore(after_blue, cell, LPV_GATHER(before_blue, injected_blue));
}
