// Blocks and their faces.
#include "block.h"

#include "core/saturate.h"

#include <stdio.h>
#include <string.h>

static const char *const face_names[CUBE_FACES] = { "-x", "+x", "-y", "+y", "-z", "+z" };

static const struct {
    const char *name;
    unsigned openings;
} kinds[MRT_BLOCK_KINDS] = {
    [MRT_BLOCK_CUBE] = { "cube", 0 },
    [MRT_BLOCK_STRAIGHT] = { "straight", 1u << CUBE_BACK | 1u << CUBE_FRONT },
    [MRT_BLOCK_LEFT] = { "left", 1u << CUBE_BACK | 1u << CUBE_RIGHT },
    [MRT_BLOCK_RIGHT] = { "right", 1u << CUBE_BACK | 1u << CUBE_LEFT },
};

const char *mrt_face_name(int face)
{
    return face_names[face];
}

int mrt_face_of_name(const char *name)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (strcmp(name, face_names[f]) == 0) return f;
    return -1;
}

const char *mrt_kind_name(enum mrt_block_kind kind)
{
    return kinds[kind].name;
}

unsigned mrt_kind_openings(enum mrt_block_kind kind)
{
    return kinds[kind].openings;
}

int mrt_hole_part(float s, float t)
{
    const int i = int_saturated((double)(s * MRT_HOLES), 0, MRT_HOLES - 1);
    const int j = int_saturated((double)(t * MRT_HOLES), 0, MRT_HOLES - 1);
    return i + j * MRT_HOLES;
}

void mrt_block_init(struct mrt_block *block, const char *name, enum mrt_block_kind kind)
{
    *block = (struct mrt_block){ .kind = kind, .open = mrt_kind_openings(kind) };
    snprintf(block->name, sizeof block->name, "%s", name);
    for (int f = 0; f < CUBE_FACES; f++) block->neighbor[f].block = -1;
}

void mrt_block_set_box(struct mrt_block *block, struct box3 box)
{
    for (int c = 0; c < MRT_CORNERS; c++)
        for (int a = 0; a < 3; a++)
            block->corner[c].raw[a] = c >> a & 1 ? box.max.raw[a] : box.min.raw[a];
}

int mrt_face_corner(int face, int i)
{
    vec3s p = cube_face_point(face, i == 1 || i == 2, i >= 2);
    return (p.x > 0.0f) | (p.y > 0.0f) << 1 | (p.z > 0.0f) << 2;
}

int mrt_face_corner_index(int face, int corner)
{
    for (int i = 0; i < 4; i++)
        if (mrt_face_corner(face, i) == corner) return i;
    return -1;
}

int mrt_face_across_edge(int face, int i)
{
    int a = mrt_face_corner(face, i), b = mrt_face_corner(face, (i + 1) % 4);
    for (int f = 0; f < CUBE_FACES; f++) {
        if (f == face) continue;
        if (mrt_face_corner_index(f, a) >= 0 && mrt_face_corner_index(f, b) >= 0) return f;
    }
    return -1;
}

int mrt_neighbor_corner(const struct mrt_block *block, int face, int corner)
{
    const struct mrt_neighbor *n = &block->neighbor[face];
    int i = (mrt_face_corner_index(face, corner) - n->rolls + 4) % 4;
    // Half a turn around v exchanges s and 1 − s: corner 0 with 1, 2 with 3.
    return mrt_face_corner(n->face, i ^ 1);
}

// The face beside `face` with the edge between two of its corners.
static int face_beside(int face, int a, int b)
{
    for (int i = 0; i < 4; i++) {
        int c = mrt_face_corner(face, i), d = mrt_face_corner(face, (i + 1) % 4);
        if ((c == a && d == b) || (c == b && d == a)) return mrt_face_across_edge(face, i);
    }
    return -1;
}

int mrt_neighbor_direction(const struct mrt_block *block, int face, int direction)
{
    const struct mrt_neighbor *n = &block->neighbor[face];
    if (direction == face) return cube_opposite(n->face);
    if (direction == cube_opposite(face)) return n->face;
    for (int i = 0; i < 4; i++) {
        if (mrt_face_across_edge(face, i) != direction) continue;
        int a = mrt_neighbor_corner(block, face, mrt_face_corner(face, i));
        int b = mrt_neighbor_corner(block, face, mrt_face_corner(face, (i + 1) % 4));
        return face_beside(n->face, a, b);
    }
    return -1;
}
