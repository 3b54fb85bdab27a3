// Pixels whose light needs one lookup: on a wall, or amid a block. Their blocks are affine cubes,
// found by tables in images (block_rows.glsl).
// Needs light_map.glsl.
#ifndef AG_MRT_ROWS_GLSL
#define AG_MRT_ROWS_GLSL

// A place of a block, and the faces around it.
struct mrt_around {
    vec3 cell;
    vec3 normal; // in the cell
    uvec2 faces; // faces_by_rows
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
    mat3 edges = edges_by_rows(rows.inverse);
    mrt_around around;
    around.cell = rows.cell;
    around.normal = normalize(normal * edges);
    around.faces = faces_by_rows(rows.block);
    found = found && faces_no_wall(rows, around, normal);
    mrt_wall wall = wall_of(around.faces, around.cell, around.normal);
    int face = max(wall.face, 0);
    light = wall_light(tile_of(around.faces, face), face, around.cell, around.normal,
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
