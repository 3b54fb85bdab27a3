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

// What arrives along each axis; coefficients are c0, cy, cz, cx. West, under and north send along +x, +y, +z.
vec4 arriving(vec4 west, vec4 east, vec4 under, vec4 over, vec4 north, vec4 south)
{
    vec4 x = west + east, y = under + over, z = north + south;
    vec4 dx = west - east, dy = under - over, dz = north - south;
    return vec4(lpv.keep * (x.x + y.x + z.x) + lpv.drive * (dx.w + dy.y + dz.z),
                lpv.across * (x.y + z.y) + lpv.along * y.y + lpv.aim * dy.x,
                lpv.across * (x.z + y.z) + lpv.along * z.z + lpv.aim * dz.x,
                lpv.across * (y.w + z.w) + lpv.along * x.w + lpv.aim * dx.x);
}

#define LPV_GATHER(before, injected)                                                                           \
    (texelFetch(injected, cell, 0) +                                                                           \
     arriving(texelFetch(before, west, 0) * has_west, texelFetch(before, east, 0) * has_east,                  \
              texelFetch(before, under, 0) * has_under, texelFetch(before, over, 0) * has_over,                \
              texelFetch(before, north, 0) * has_north, texelFetch(before, south, 0) * has_south))

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
