// Lookups on one side of walls. Trilinear filtering weighs the two cells around a position along
// each axis; a surface between their centres removes its covered share of the weight of the cell
// beyond it. Include after lpv_grid.glsl; define LPV_WALLS_BINDING.
#ifndef AG_LPV_LOOKUP_GLSL
#define AG_LPV_LOOKUP_GLSL

layout(constant_id = LPV_CONSTANT_GEOMETRY) const int LPV_GEOMETRY = LPV_GEOMETRY_OFF;

layout(set = 0, binding = LPV_WALLS_BINDING, scalar) readonly buffer lpv_walls
{
    // [cell], 10 bits per axis for the interval from the next lower centre to this cell's: lines
    // that a surface crosses (4 bits); whether these are all on the side of the lower centre, of
    // the higher one (2 bits); the mean of their first and last place (4 bits).
    uint walls[];
};

// Surfaces between two centres.
struct lpv_wall {
    float from_below, from_above; // the occluded share of the light on either side
    float place;                  // in that interval, 0 to 1
};

// Between the next lower centre along an axis and this cell's.
lpv_wall lpv_wall_below(ivec3 cell, ivec3 cells, int axis)
{
    uint bits = walls[(cell.z * cells.y + cell.y) * cells.x + cell.x] >> (10 * axis);
    float lines = float(bits & LPV_MOST_LINES) / float(LPV_LINES * LPV_LINES);
    vec2 share = mix(vec2(lines), vec2(1.0), notEqual(bits & uvec2(16u, 32u), uvec2(0u)));
    share = min(lpv.occlusion * share, vec2(1.0));
    float place = (float(bits >> 6 & (LPV_PLACES - 1u)) + 0.5) / float(LPV_PLACES);
    return lpv_wall(share.x, share.y, place);
}

// A lookup for a surface: positions in cells.
struct lpv_lookup {
    vec3 at;
    vec3 side;        // a position nearby, on the same side of walls
    vec3 surface, n;  // position and normal
    float reach;      // of the surface's own places along its normal
    ivec3 low;        // the next lower centres of `at`
    bvec3 is_further; // not those of the surface
    ivec3 own;        // a cell on the side of the position
};

// Distance in front of a surface that is surely more than the rounding of its position, cells.
const float LPV_IN_FRONT = 1.0 / 64.0;

// `seen`: a position that no wall separates from the surface, as near a centre of a cell as known.
lpv_lookup lpv_lookup_at(vec3 at, vec3 surface, vec3 n, vec3 seen, ivec3 cells)
{
    ivec3 low = ivec3(floor(at - 0.5)), of_surface = ivec3(floor(surface + LPV_IN_FRONT * n - 0.5));
    bvec3 is_further = notEqual(low, of_surface);
    ivec3 own = mix(ivec3(floor(seen)), low + ivec3(lessThan(low, of_surface)), is_further);
    return lpv_lookup(at, at, surface, n, 2.0 / float(LPV_PLACES), low, is_further,
                      clamp(own, ivec3(0), cells - 1));
}

// Whether a lookup is above a wall between two centres. Further away than the surface it is in
// front of the wall, unless that is the surface itself: its plane crosses the line between the
// centres near the wall. Places of a slope are those of all lines of a side of a cell.
bool lpv_above(lpv_lookup lookup, ivec3 own, int axis, float place)
{
    float low = float(lookup.low[axis]) + 0.5, along = lookup.n[axis];
    bool above = lookup.side[axis] - low > place;
    if (!lookup.is_further[axis]) return above;
    vec3 beside = vec3(own) + 0.5 - lookup.surface, across = lookup.n;
    beside[axis] = across[axis] = 0.0;
    float plane = lookup.surface[axis] - low - dot(across, beside) / along;
    float reach = lookup.reach + 0.5 * dot(abs(across), vec3(1.0)) / abs(along);
    if (abs(place - plane) < reach) return above;
    return place < plane;
}

// The cell of a position, on its side of the walls around: across a wall that crosses most of the
// interval between two centres it is the one whose centre the position sees.
ivec3 lpv_cell_on_side(lpv_lookup lookup, ivec3 cells)
{
    ivec3 own = lookup.own, nearest = ivec3(floor(lookup.at));
    for (int i = 0; i < 6; i++) {
        int axis = i % 3;
        ivec3 cell = own;
        cell[axis] = lookup.low[axis] + 1;
        if (cell[axis] < 1 || cell[axis] >= cells[axis]) continue;
        lpv_wall wall = lpv_wall_below(cell, cells, axis);
        bool closed = max(wall.from_below, wall.from_above) >= 0.5,
             above = lpv_above(lookup, own, axis, wall.place);
        own[axis] = closed ? lookup.low[axis] + (above ? 1 : 0) : nearest[axis];
    }
    return own;
}

// The position, moved so that a filtered lookup does not see through walls of the grid of `cells`.
// The cell on its side is known after the first round over the axes.
vec3 lpv_visible(lpv_lookup lookup, ivec3 cells)
{
    if (LPV_GEOMETRY != LPV_GEOMETRY_SCENE) return lookup.at;
    ivec3 own = lookup.own;
    vec3 result = lookup.at;
    for (int i = 0; i < 6; i++) {
        int axis = i % 3;
        float low = float(lookup.low[axis]), f = lookup.at[axis] - 0.5 - low;
        ivec3 cell = own;
        cell[axis] = lookup.low[axis] + 1;
        if (cell[axis] < 1 || cell[axis] >= cells[axis]) continue;
        lpv_wall wall = lpv_wall_below(cell, cells, axis);
        bool above = lpv_above(lookup, own, axis, wall.place);
        float covered = above ? wall.from_above : wall.from_below;
        if (covered == 0.0) {
            result[axis] = lookup.at[axis];
            continue;
        }
        f = above ? 1.0 - (1.0 - f) * (1.0 - covered) : f * (1.0 - covered);
        result[axis] = low + 0.5 + f;
        own[axis] = lookup.low[axis] + (above ? 1 : 0);
    }
    return result;
}

#endif
