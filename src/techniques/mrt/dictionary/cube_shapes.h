// The cubes of the block dictionary, one for each set of openings up to rotation: six for
// two-dimensional mazes, with a floor and a ceiling (Loos 2015, section 3.5.1), nine for
// three-dimensional ones.
#pragma once

#include "techniques/mrt/dictionary/shape.h"

enum mrt_maze { MRT_MAZE_2D, MRT_MAZE_3D };
enum { MRT_MAX_CUBES = 9 };

int mrt_cube_count(enum mrt_maze maze);
unsigned mrt_cube_missing(enum mrt_maze maze, int cube); // openings, a bit for each face
// Openings of all cubes: 12 in the plane, 24 in space.
int mrt_cube_openings(enum mrt_maze maze);

// The cube of the dictionary that has the openings of a block once it is turned. False: none has,
// as in the plane for a block without a floor.
struct mrt_cube_place {
    int cube;
    mat3s block_from_cube;
};
bool mrt_cube_find(enum mrt_maze maze, unsigned missing, struct mrt_cube_place *place);

// The face that a rotation takes a face to.
int mrt_turned_face(mat3s to_from, int face);
// The texel of `from` that a rotation takes to a texel of `to`; −1: an opening of `from`.
int mrt_turned_texel(const struct mrt_shape *from, mat3s to_from, const struct mrt_shape *to,
                     int texel);
