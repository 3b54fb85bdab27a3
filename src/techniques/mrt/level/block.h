// A block of a level: a dictionary shape in a unit cell [−½, ½]³ that eight corners warp into the
// scene (Loos 2015, section 3.5.2), with the blocks beyond its openings.
#pragma once

#include "techniques/mrt/dictionary/interface.h"

enum { MRT_CORNERS = 8, MRT_MAX_BLOCKS = 1024, MRT_NAME_BYTES = 64 };

// Cylinders run through the middle of their cell: straight from −z to +z, or bent from −z to the
// side that is left or right along the way, y being up.
#define MRT_CYLINDER_RADIUS 0.375f // of the cell
enum mrt_block_kind {
    MRT_BLOCK_CUBE,
    MRT_BLOCK_STRAIGHT,
    MRT_BLOCK_LEFT,  // to +x
    MRT_BLOCK_RIGHT, // to −x
    MRT_BLOCK_KINDS
};

// The block beyond an opening. `rolls` quarter turns (0…3), from u to v, lead from the frame of
// this block's face to that of the neighbour's face rotated by 180° around v.
struct mrt_neighbor {
    int block; // −1: none
    int face;  // of the neighbour
    int rolls;
};

// A wall may have holes, such as doors, through which light passes to its neighbour: the share of
// each part of the face that is open (dictionary/interface.h), s and t in place of u and v.
struct mrt_holes {
    float share[MRT_HOLE_PARTS];
};

struct mrt_block {
    char name[MRT_NAME_BYTES];
    enum mrt_block_kind kind;
    unsigned open;             // bit f: face f of the cell is an opening
    vec3s corner[MRT_CORNERS]; // world; x is high in corner c if c & 1, y if c & 2, z if c & 4
    struct mrt_neighbor neighbor[CUBE_FACES]; // beyond an opening, or a wall with holes
    struct mrt_holes holes[CUBE_FACES];       // 0 but for walls with a neighbour
};

static inline bool mrt_block_is_open(const struct mrt_block *block, int face)
{
    return block->open >> face & 1u;
}

static inline bool mrt_block_has_holes(const struct mrt_block *block, int face)
{
    return block->neighbor[face].block >= 0 && !mrt_block_is_open(block, face);
}

// The part of a face at (s, t), and the share of it that is open: 0 where the wall has no holes.
int mrt_hole_part(float s, float t);
static inline float mrt_block_hole_at(const struct mrt_block *block, int face, float s, float t)
{
    return block->holes[face].share[mrt_hole_part(s, t)];
}

// The block beyond an opening; −1: none, or the face is a wall.
static inline int mrt_block_beyond(const struct mrt_block *block, int face)
{
    return mrt_block_is_open(block, face) ? block->neighbor[face].block : -1;
}

// "-x", "+x", "-y", …
const char *mrt_face_name(int face);
int mrt_face_of_name(const char *name); // −1: no such face

const char *mrt_kind_name(enum mrt_block_kind kind);
// Openings of a cylinder; 0 for a cube, which may have any.
unsigned mrt_kind_openings(enum mrt_block_kind kind);

// A block without neighbours and openings; an axis-aligned box.
void mrt_block_init(struct mrt_block *block, const char *name, enum mrt_block_kind kind);
void mrt_block_set_box(struct mrt_block *block, struct box3 box);

// ---- corners of faces

// Corner of the cell at corner i (0…3, counter-clockwise from outside: (s, t) = (0, 0), (1, 0),
// (1, 1), (0, 1)) of a face, and its inverse, −1 where the face lacks that corner.
int mrt_face_corner(int face, int i);
int mrt_face_corner_index(int face, int corner);
// The other face with the edge from corner i to i + 1 of a face.
int mrt_face_across_edge(int face, int i);
// The corner of the neighbour's cell that meets this corner of an opening.
int mrt_neighbor_corner(const struct mrt_block *block, int face, int corner);
// The face of the neighbour's cell with the direction of a face of this one, if the two cells were
// cubes: that of `face` itself is opposite to the neighbour's opening.
int mrt_neighbor_direction(const struct mrt_block *block, int face, int direction);

// ---- the warp

vec3s mrt_warp_point(const vec3s corner[MRT_CORNERS], vec3s cell);
// Columns: derivatives by x, y and z of the cell.
mat3s mrt_warp_jacobian(const vec3s corner[MRT_CORNERS], vec3s cell);
struct box3 mrt_warp_bounds(const vec3s corner[MRT_CORNERS]);
// Whether the warp mirrors or folds over: its Jacobian's determinant is not positive throughout.
bool mrt_warp_folds(const vec3s corner[MRT_CORNERS]);
// Whether the block is a parallelepiped, to the rounding of its corners.
bool mrt_warp_is_affine(const vec3s corner[MRT_CORNERS]);
// Outward unit normal of a face in the scene, at a point of that face.
vec3s mrt_warp_face_normal(const vec3s corner[MRT_CORNERS], int face, vec3s cell);
// Newton's method. False where it does not converge, for points far outside the block.
bool mrt_warp_inverse(const vec3s corner[MRT_CORNERS], vec3s world, vec3s *cell);
