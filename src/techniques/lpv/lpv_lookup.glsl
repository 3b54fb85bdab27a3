// Lookups on one side of walls. Trilinear filtering weighs the two cells around a position along
// each axis; a surface between their centres removes its covered share of the weight of the cell
// beyond it. Include after lpv_grid.glsl; define LPV_WALLS_BINDING.
#ifndef AG_LPV_LOOKUP_GLSL
#define AG_LPV_LOOKUP_GLSL

layout(constant_id = LPV_CONSTANT_GEOMETRY) const int LPV_GEOMETRY = LPV_GEOMETRY_OFF;

layout(set = 0, binding = LPV_WALLS_BINDING, scalar) readonly buffer lpv_walls
{
    // [cell], 10 bits per axis for the interval from the next lower centre to this cell's: lines
    // that a surface crosses (5 bits), sum of its first and last place (5 bits).
    uint walls[];
};

uint lpv_wall_bits(ivec3 cell, ivec3 cells, int axis)
{
    return walls[(cell.z * cells.y + cell.y) * cells.x + cell.x] >> (10 * axis);
}

float lpv_wall_place(uint wall)
{
    return float((wall >> 5 & 31u) + 1u) / float(2u * LPV_PLACES);
}

// The share of the light that surfaces occlude between the next lower centre along an axis and this
// cell's, and their place in that interval, 0 to 1.
vec2 lpv_wall_below(ivec3 cell, ivec3 cells, int axis)
{
    uint wall = lpv_wall_bits(cell, cells, axis);
    return vec2(min(lpv.occlusion * float(wall & 31u) / float(LPV_LINES * LPV_LINES), 1.0),
                lpv_wall_place(wall));
}

// The cell of a position, on its side of the walls around: across a wall that crosses most of the
// interval between two centres it is the one whose centre the position sees.
ivec3 lpv_cell_on_side(vec3 at, ivec3 cells)
{
    ivec3 own = ivec3(floor(at));
    if (LPV_GEOMETRY != LPV_GEOMETRY_SCENE) return own;
    for (int i = 0; i < 6; i++) {
        int axis = i % 3;
        float low = floor(at[axis] - 0.5), f = at[axis] - 0.5 - low;
        ivec3 cell = own;
        cell[axis] = int(low) + 1;
        if (cell[axis] < 1 || cell[axis] >= cells[axis]) continue;
        uint wall = lpv_wall_bits(cell, cells, axis);
        bool closed = (wall & 31u) >= uint(LPV_LINES * LPV_LINES / 2);
        own[axis] = closed ? int(low) + (f > lpv_wall_place(wall) ? 1 : 0) : int(floor(at[axis]));
    }
    return own;
}

// The position, moved so that a filtered lookup does not see through walls of the grid of `cells`.
// `own` is the cell on the side of the position, known after the first round over the axes.
vec3 lpv_visible(vec3 at, ivec3 cells)
{
    if (LPV_GEOMETRY != LPV_GEOMETRY_SCENE) return at;
    ivec3 own = clamp(ivec3(floor(at)), ivec3(0), cells - 1);
    vec3 result = at;
    for (int i = 0; i < 6; i++) {
        int axis = i % 3;
        float low = floor(at[axis] - 0.5), f = at[axis] - 0.5 - low;
        ivec3 cell = own;
        cell[axis] = int(low) + 1;
        if (cell[axis] < 1 || cell[axis] >= cells[axis]) continue;
        vec2 wall = lpv_wall_below(cell, cells, axis);
        float covered = wall.x;
        bool above = f > wall.y;
        if (covered == 0.0) {
            result[axis] = at[axis];
            continue;
        }
        f = above ? 1.0 - (1.0 - f) * (1.0 - covered) : f * (1.0 - covered);
        result[axis] = low + 0.5 + f;
        own[axis] = int(low) + (above ? 1 : 0);
    }
    return result;
}

#endif
