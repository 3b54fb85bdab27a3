// Pixels whose light needs one lookup: on a wall, or amid a block. Their blocks are affine cubes,
// found by tables in images (block_rows.glsl).
// Needs light_map.glsl; binding numbers MRT_BLOCK_ROWS_BINDING and MRT_CELL_ROWS_BINDING.
#ifndef AG_MRT_ROWS_GLSL
#define AG_MRT_ROWS_GLSL

#include "techniques/mrt/gpu/block_rows.glsl"

// [cell of the lookup grid]: four blocks in it, or MRT_NO_BLOCK.
layout(set = 0, binding = MRT_CELL_ROWS_BINDING, rgba32ui) uniform readonly uimage2D cell_rows;

struct mrt_rows {
    uint block;
    vec3 inverse[3];
    vec3 cell;
};

mrt_rows rows_of(uint block, vec3 world)
{
    mrt_rows rows;
    rows.block = block;
    rows.cell = cell_by_rows(block, world, rows.inverse);
    return rows;
}

// As `locate`, of the blocks in the cell. False: the point is in none of them.
bool find_rows(vec3 world, out mrt_rows rows)
{
    ivec3 cells = ivec3(level.cells_x, level.cells_y, level.cells_z);
    vec3 at = (world - level.grid_origin_m) * level.cells_per_m;
    ivec3 i = clamp(ivec3(at), ivec3(0), cells - 1);
    uvec4 list = imageLoad(cell_rows, light_map_at(uint((i.z * cells.y + i.y) * cells.x + i.x)));
    bool found;
    do {
        rows = rows_of(list.x == MRT_NO_BLOCK ? 0u : list.x, world);
        found = list.x != MRT_NO_BLOCK && largest_of(rows.cell) <= 0.5;
        list = uvec4(list.yzw, MRT_NO_BLOCK);
    } while (!found && list.x != MRT_NO_BLOCK);
    return found && all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(cells)));
}

// A place of a block, and the faces around it.
struct mrt_around {
    vec3 cell;
    vec3 normal; // in the cell
    uint faces;  // faces_by_rows
};

// Whether way_to_wall finds none.
bool faces_no_wall(mrt_rows rows, mrt_around around, vec3 normal)
{
    vec3 to;
    for (int a = 0; a < 3; a++) to[a] = dot(rows.inverse[a], normal);
    float least = MRT_AWAY_COSINE * length(to);
    bool none = true;
    for (int a = 0; a < 3; a++) {
        bool high = to[a] > 0.0;
        float distance = 0.5 - (high ? rows.cell[a] : -rows.cell[a]);
        bool wall = is_wall(around.faces, face_of(a, high));
        none = none && !(wall && distance <= MRT_WALL_DISTANCE[0] && abs(to[a]) >= least);
    }
    return none;
}

// Whether wall_beyond looks beyond no opening.
bool is_beside_no_opening(mrt_around around)
{
    bool none = true;
    for (int a = 0; a < 3; a++) {
        bool opening = is_opening(around.faces, face_of(a, around.cell[a] > 0.0));
        none = none && !(opening && 0.5 - abs(around.cell[a]) <= MRT_WALL_DISTANCE.x &&
                         abs(around.normal[a]) < MRT_WALL_COSINE.x);
    }
    return none;
}

const int MRT_OF_WALL = 0, MRT_OF_PROBES = 1, MRT_OF_SEVERAL = 2;

// The kind of lookups that light a surface; `light` is that of a wall.
int plain_light(vec3 position, vec3 normal, mrt_lobe lobe, out mrt_light light)
{
    mrt_rows rows;
    bool found = find_rows(position + level.offset_m * normal, rows);
    mat3 edges = edges_by_rows(rows.block);
    mrt_around around;
    around.cell = rows.cell;
    around.normal = normalize(normal * edges);
    around.faces = faces_by_rows(rows.block);
    found = found && faces_no_wall(rows, around, normal);
    mrt_wall wall = wall_of(around.faces, around.cell, around.normal);
    int face = max(wall.face, 0);
    light = wall_light(tile_by_rows(rows.block, face), face, around.cell, around.normal,
                       light_map_lobe(turned_by(edges, lobe.surface.along), lobe.surface.share));
    if (found && wall.share == 1.0) return MRT_OF_WALL;
    bool probes = PROBES && wall.share == 0.0 && is_beside_no_opening(around);
    return found && probes ? MRT_OF_PROBES : MRT_OF_SEVERAL;
}

// Light of MRT_OF_PROBES.
mrt_light amid_light(vec3 position, vec3 normal, mrt_lobe lobe)
{
    mrt_rows rows;
    find_rows(position + level.offset_m * normal, rows);
    return bricks_light(mrt_place(int(rows.block), rows.cell, 0.0), normal, lobe);
}

#endif
