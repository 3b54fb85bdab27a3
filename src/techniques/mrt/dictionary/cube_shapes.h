// The cubes of the block dictionary, one for each set of openings up to rotation: six for
// two-dimensional mazes, with a floor and a ceiling (Loos 2015, section 3.5.1), nine for
// three-dimensional ones; and the three tubes of tunnels.
#pragma once

#include "techniques/mrt/dictionary/shape.h"

enum mrt_maze {
    MRT_MAZE_2D,
    MRT_MAZE_3D,
    MRT_TUNNEL,
    MRT_MAZE_AUTO // of options alone: what the level needs
};
// A tube has four faces' worth of texels around and along.
enum { MRT_MAX_CUBES = 9, TUBE_TEXELS = 4 };

int mrt_dictionary_shapes(enum mrt_maze maze);
// Shape i, with `texels` along an edge of a cube.
struct mrt_shape mrt_dictionary_shape(enum mrt_maze maze, int texels, int i);
// Texels along an edge of a face of these shapes: the whole wall of a tube is one face.
static inline int mrt_face_texels(enum mrt_maze maze, int texels)
{
    return maze == MRT_TUNNEL ? TUBE_TEXELS * texels : texels;
}
// Openings of all shapes: 12 in the plane, 24 in space, 6 of tubes.
int mrt_dictionary_openings(enum mrt_maze maze);
// The shapes that light enters by the back: one stands for all cubes, tubes are three. Light that
// enters a bend by its end passes the other bend, rotated.
int mrt_entered_shapes(enum mrt_maze maze);
struct mrt_shape mrt_entered_shape(enum mrt_maze maze, int texels, int i);
unsigned mrt_cube_missing(enum mrt_maze maze, int cube); // openings, a bit for each face
// The cube of the dictionary that has the openings of a block once it is rotated. False: none has,
// as in the plane for a block without a floor.
struct mrt_cube_place {
    int cube;
    mat3s block_from_cube;
};
bool mrt_cube_find(enum mrt_maze maze, unsigned missing, struct mrt_cube_place *place);

// Whether light may pass through holes in this wall: in the plane floors and ceilings are closed.
static inline bool mrt_wall_may_have_holes(enum mrt_maze maze, int face)
{
    return maze == MRT_MAZE_3D || (maze == MRT_MAZE_2D && face / 2 != 1);
}

// The face that a rotation takes a face to.
int mrt_rotated_face(mat3s to_from, int face);
// The texel of `from` that a rotation takes to a texel of `to`; −1: an opening of `from`.
int mrt_rotated_texel(const struct mrt_shape *from, mat3s to_from, const struct mrt_shape *to,
                      int texel);
