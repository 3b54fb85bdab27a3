// The list of dictionary cubes, and how blocks match it.
#include "cube_shapes.h"

#include "core/vec.h"

enum {
    L = 1 << CUBE_LEFT,
    R = 1 << CUBE_RIGHT,
    B = 1 << CUBE_BOTTOM,
    T = 1 << CUBE_TOP,
    BACK = 1 << CUBE_BACK,
    F = 1 << CUBE_FRONT,
};

static const unsigned PLANE[] = { 0, F, R | F, BACK | F, L | R | F, L | R | BACK | F };
static const unsigned SPACE[] = { 0,
                                  F,
                                  R | F,
                                  BACK | F,
                                  R | T | F,
                                  L | R | F,
                                  L | R | BACK | F,
                                  R | T | BACK | F,
                                  L | R | T | BACK | F };
_Static_assert(sizeof SPACE / sizeof *SPACE == MRT_MAX_CUBES,
               "all cubes of the dictionary in space");

int mrt_dictionary_shapes(enum mrt_maze maze)
{
    if (maze == MRT_TUNNEL) return 3;
    return maze == MRT_MAZE_2D ? (int)(sizeof PLANE / sizeof *PLANE) : MRT_MAX_CUBES;
}

unsigned mrt_cube_missing(enum mrt_maze maze, int cube)
{
    return maze == MRT_MAZE_2D ? PLANE[cube] : SPACE[cube];
}

struct mrt_shape mrt_dictionary_shape(enum mrt_maze maze, int texels, int i)
{
    if (maze == MRT_TUNNEL) return mrt_tube(TUBE_TEXELS * texels, (enum tube_bend)i);
    return mrt_cube(texels, mrt_cube_missing(maze, i));
}

int mrt_entered_shapes(enum mrt_maze maze)
{
    return maze == MRT_TUNNEL ? mrt_dictionary_shapes(maze) : 1;
}

struct mrt_shape mrt_entered_shape(enum mrt_maze maze, int texels, int i)
{
    if (maze == MRT_TUNNEL) return mrt_dictionary_shape(maze, texels, i);
    return mrt_cube(texels, BACK);
}

int mrt_dictionary_openings(enum mrt_maze maze)
{
    int openings = 0;
    for (int i = 0; i < mrt_dictionary_shapes(maze); i++) {
        struct mrt_shape shape = mrt_dictionary_shape(maze, 1, i);
        openings += mrt_shape_openings(&shape);
    }
    return openings;
}

int mrt_rotated_face(mat3s to_from, int face)
{
    vec3s normal = glms_mat3_mulv(to_from, cube_from_face(face).col[2]);
    return cube_trace(vec3_of(0, 0, 0), normal).face;
}

static unsigned rotated_faces(mat3s to_from, unsigned faces)
{
    unsigned rotated = 0;
    for (int f = 0; f < CUBE_FACES; f++)
        if (faces >> f & 1u) rotated |= 1u << mrt_rotated_face(to_from, f);
    return rotated;
}

// Rotation i of the 24 of the cube: the face that +z is taken to, and quarter turns around it. The
// first four of MRT_MAZE_2D keep y.
static mat3s cube_rotation(enum mrt_maze maze, int i)
{
    static const int sides[4] = { CUBE_FRONT, CUBE_RIGHT, CUBE_BACK, CUBE_LEFT };
    if (maze == MRT_MAZE_2D) return cube_from_face(sides[i]);
    mat3s roll = { .col = { { { 0, 1, 0 } }, { { -1, 0, 0 } }, { { 0, 0, 1 } } } };
    mat3s rotation = cube_from_face(i / 4);
    for (int r = 0; r < i % 4; r++) rotation = glms_mat3_mul(rotation, roll);
    return rotation;
}

bool mrt_cube_find(enum mrt_maze maze, unsigned missing, struct mrt_cube_place *place)
{
    if (maze == MRT_TUNNEL) return false;
    int rotations = maze == MRT_MAZE_2D ? 4 : 24;
    for (int cube = 0; cube < mrt_dictionary_shapes(maze); cube++)
        for (int i = 0; i < rotations; i++) {
            mat3s block_from_cube = cube_rotation(maze, i);
            if (rotated_faces(block_from_cube, mrt_cube_missing(maze, cube)) != missing) continue;
            *place = (struct mrt_cube_place){ cube, block_from_cube };
            return true;
        }
    return false;
}

int mrt_rotated_texel(const struct mrt_shape *from, mat3s to_from, const struct mrt_shape *to,
                      int texel)
{
    vec3s at = mrt_shape_texel(to, texel).position;
    return mrt_shape_texel_near(from, glms_mat3_mulv(glms_mat3_transpose(to_from), at));
}
