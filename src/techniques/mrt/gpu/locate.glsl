// The block of a point, and the place in its cell [−½, ½]³: the inverse of the trilinear warp of
// level/warp.c. Needs MRT_BLOCKS_BINDING; binding numbers MRT_CELLS_BINDING and
// MRT_CANDIDATES_BINDING are the includer's. With MRT_BLOCK_ROWS_BINDING affine blocks are read
// from images.
#ifndef AG_MRT_LOCATE_GLSL
#define AG_MRT_LOCATE_GLSL

#include "techniques/mrt/gpu/face.glsl"
#include "techniques/mrt/gpu/level.glsl"
#ifdef MRT_BLOCK_ROWS_BINDING
#include "techniques/mrt/gpu/block_rows.glsl"
#endif

// Lookup grid: the first candidate of each cell and the number of them.
layout(set = 0, binding = MRT_CELLS_BINDING, scalar) readonly buffer mrt_cells
{
    uvec2 cell_table[];
};
layout(set = 0, binding = MRT_CANDIDATES_BINDING) readonly buffer mrt_candidates
{
    uint candidate_table[]; // blocks
};

layout(constant_id = MRT_CONSTANT_AFFINE) const bool AFFINE = false;

const float MRT_BEYOND = 1.0; // edges: surfaces this far outside belong to the nearest block
const float MRT_FAR = 8.0;
const float MRT_CONVERGED = 1e-5, MRT_CLOSE = 1e-3; // the latter for coordinates of few bits
const int MRT_NEWTON_STEPS = 8;

struct mrt_place {
    int block; // −1: none
    vec3 cell;
    float outside; // distance from the cell, in edges
};

vec3 warp_point(uint block, vec3 cell, out mat3 jacobian)
{
    vec3 low = 0.5 - cell, high = 0.5 + cell, sum = vec3(0.0);
    jacobian = mat3(0.0);
    for (int c = 0; c < 8; c++) {
        vec3 corner = block_table[block].corner[c];
        bvec3 is_high = bvec3((c & 1) != 0, (c & 2) != 0, (c & 4) != 0);
        vec3 w = mix(low, high, is_high), sign = mix(vec3(-1.0), vec3(1.0), is_high);
        sum += w.x * w.y * w.z * corner;
        jacobian[0] += sign.x * w.y * w.z * corner;
        jacobian[1] += sign.y * w.z * w.x * corner;
        jacobian[2] += sign.z * w.x * w.y * corner;
    }
    return sum;
}

float largest_of(vec3 v)
{
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// The inverse of the affine part.
vec3 affine_cell(uint block, vec3 world)
{
#ifdef MRT_BLOCK_ROWS_BINDING
    return rows_of(block, world).cell;
#else
    vec3 cell, way = world - block_table[block].middle;
    for (int a = 0; a < 3; a++) cell[a] = dot(block_table[block].inverse[a], way);
    return cell;
#endif
}

// From the affine part, which is exact for boxes; Newton's method otherwise.
bool warp_inverse(uint block, vec3 world, out vec3 cell)
{
    cell = affine_cell(block, world);
    if (AFFINE) return true;
    float last = MRT_FAR;
    for (int i = 0; i < MRT_NEWTON_STEPS; i++) {
        mat3 jacobian;
        if (any(isnan(cell)) || !(largest_of(cell) < MRT_FAR)) return false;
        vec3 residual = world - warp_point(block, cell, jacobian);
        vec3 advance = inverse(jacobian) * residual;
        cell += advance;
        last = largest_of(advance);
        if (last < MRT_CONVERGED) return true;
    }
    return last < MRT_CLOSE && !any(isnan(cell));
}

// False: the point is too far from the block.
bool place_in(uint block, vec3 world, out mrt_place place)
{
    place.block = int(block);
    bool found = warp_inverse(block, world, place.cell);
    place.outside = max(largest_of(place.cell) - 0.5, 0.0);
    return found && place.outside < MRT_BEYOND;
}

// The block nearest to the point. Lists of candidates are long: of blocks up to MRT_BEYOND away.
mrt_place locate(vec3 world)
{
    mrt_place nearest = mrt_place(-1, vec3(0.0), MRT_BEYOND);
#ifdef MRT_BLOCK_ROWS_BINDING
    mrt_rows rows;
    if (AFFINE && find_rows(world, rows)) nearest = mrt_place(int(rows.block), rows.cell, 0.0);
#endif
    vec3 at = (world - level.grid_origin_m) * level.cells_per_m;
    ivec3 cells = ivec3(level.cells_x, level.cells_y, level.cells_z);
    if (any(lessThan(at, vec3(0.0))) || any(greaterThanEqual(at, vec3(cells)))) return nearest;
    ivec3 i = ivec3(at);
    uvec2 list = cell_table[(i.z * cells.y + i.y) * cells.x + i.x];
    for (uint k = 0u; k < list.y && nearest.outside > 0.0; k++) {
        mrt_place place;
        if (place_in(candidate_table[list.x + k], world, place) && place.outside < nearest.outside)
            nearest = place;
    }
    return nearest;
}

mat3 world_from_cell(mrt_place place)
{
    mat3 jacobian;
    if (AFFINE) return edges_of_block(uint(place.block));
    warp_point(uint(place.block), place.cell, jacobian);
    return jacobian;
}

// The surface's normal in the cell: gradients transform with the transposed Jacobian.
vec3 normal_in_cell(mrt_place place, vec3 normal)
{
    return normalize(transpose(world_from_cell(place)) * normal);
}

// Directions turn with the cell's edges: a rotation of boxes.
vec3 turned_by(mat3 edges, vec3 direction)
{
    vec3 squares = vec3(dot(edges[0], edges[0]), dot(edges[1], edges[1]), dot(edges[2], edges[2]));
    return (direction * edges) * inversesqrt(max(squares, vec3(1e-20)));
}

vec3 direction_in_cell(mrt_place place, vec3 direction)
{
    return turned_by(world_from_cell(place), direction);
}

#endif
