// Coverage masks: each face between two cells has LPV_LINES² sampling lines, from the centre of one
// cell to that of the next; a line that a triangle crosses sets its bit, and one of LPV_PLACES bits
// for the place of the crossing between the two centres. Setting a bit is
// idempotent: neither the order of triangles nor their grouping into draws changes the result.
//
// One invocation takes one triangle; the whole workgroup shares a large one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/scene/scene_triangles.glsl"
#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = SCENE_TRIANGLES_LOCAL) in;

layout(set = 0, binding = 12, scalar) buffer lpv_coverage
{
    uint masks[]; // [cell][axis]: of the low faces
};

const int MAX_LINES = 64; // that one invocation tests alone

shared uint large[SCENE_TRIANGLES_LOCAL];
shared uint large_count;

// Lines along an axis that cross the bounding box of a triangle.
struct line_range {
    ivec2 first, count;
};

// Corners in cells from the grid's corner; false for NaN, infinite or far ones.
bool corners_of(uvec3 vertices, out mat3 corners)
{
    mat3 world = scene_triangle_positions(vertices);
    bool valid = true;
    for (int k = 0; k < 3; k++) {
        corners[k] = lpv_cells_from_world(world[k]);
        valid = valid && all(lessThan(abs(corners[k]), vec3(1e6)));
    }
    return valid;
}

vec2 projected(vec3 v, int axis)
{
    return vec2(v[(axis + 1) % 3], v[(axis + 2) % 3]);
}

line_range lines_of(mat3 corners, int axis)
{
    vec2 a = projected(corners[0], axis), b = projected(corners[1], axis),
         c = projected(corners[2], axis);
    // Line i is at (i + 1/2) / LPV_LINES cells.
    vec2 low = min(a, min(b, c)) * float(LPV_LINES) - 0.5,
         high = max(a, max(b, c)) * float(LPV_LINES) - 0.5;
    ivec3 cells = lpv_cells();
    ivec2 end = ivec2(cells[(axis + 1) % 3], cells[(axis + 2) % 3]) * LPV_LINES - 1;
    line_range lines;
    lines.first = max(ivec2(ceil(low)), ivec2(0));
    lines.count = max(min(ivec2(floor(high)), end) - lines.first + 1, ivec2(0));
    return lines;
}

// Twice the signed area of (p, a, b). Swapping a and b flips the sign exactly, so that triangles
// with a common edge leave no gap.
float side_of(vec2 p, vec2 a, vec2 b)
{
    precise vec2 u = a - p, v = b - p;
    precise float left = u.x * v.y, right = u.y * v.x;
    precise float side = left - right;
    return side;
}

void cross_line(uvec3 vertices, mat3 corners, int axis, ivec2 line)
{
    vec2 p = (vec2(line) + 0.5) / float(LPV_LINES);
    vec2 a = projected(corners[0], axis), b = projected(corners[1], axis),
         c = projected(corners[2], axis);
    vec3 weight = vec3(side_of(p, b, c), side_of(p, c, a), side_of(p, a, b));
    bool inside = all(greaterThanEqual(weight, vec3(0.0))) || all(lessThanEqual(weight, vec3(0.0)));
    float area = weight.x + weight.y + weight.z;
    if (!inside || area == 0.0) return; // parallel to the line
    weight /= area;
    vec3 depth = vec3(corners[0][axis], corners[1][axis], corners[2][axis]);
    ivec3 cell;
    float at = dot(weight, depth) + 0.5;
    cell[axis] = int(floor(at)); // its low face is the nearest
    cell[(axis + 1) % 3] = line.x / LPV_LINES;
    cell[(axis + 2) % 3] = line.y / LPV_LINES;
    if (!lpv_inside(cell) || !scene_triangle_solid(vertices, weight)) return;
    ivec2 within = line % LPV_LINES;
    uint place = min(uint(fract(at) * LPV_PLACES), LPV_PLACES - 1u);
    atomicOr(masks[3 * lpv_index(cell) + axis],
             1u << (within.y * LPV_LINES + within.x) | 1u << (LPV_LINES * LPV_LINES + place));
}

// Every `stride`th line from index `first`.
void cross_lines(uvec3 vertices, mat3 corners, int first, int stride)
{
    for (int axis = 0; axis < 3; axis++) {
        line_range lines = lines_of(corners, axis);
        for (int i = first; i < lines.count.x * lines.count.y; i += stride)
            cross_line(vertices, corners, axis,
                       lines.first + ivec2(i % lines.count.x, i / lines.count.x));
    }
}

int max_lines(mat3 corners)
{
    int result = 0;
    for (int axis = 0; axis < 3; axis++) {
        ivec2 count = lines_of(corners, axis).count;
        result = max(result, count.x * count.y);
    }
    return result;
}

void main()
{
    uint lane = gl_LocalInvocationIndex, triangle = gl_GlobalInvocationID.x;
    if (lane == 0u) large_count = 0u;
    barrier();
    mat3 corners;
    if (triangle < push.triangle_count) {
        uvec3 vertices = scene_triangle(triangle);
        if (corners_of(vertices, corners)) {
            if (max_lines(corners) <= MAX_LINES)
                cross_lines(vertices, corners, 0, 1);
            else
                large[atomicAdd(large_count, 1u)] = triangle;
        }
    }
    barrier();
    for (uint i = 0u; i < large_count; i++) {
        uvec3 vertices = scene_triangle(large[i]);
        if (corners_of(vertices, corners))
            cross_lines(vertices, corners, int(lane), SCENE_TRIANGLES_LOCAL);
    }
}
