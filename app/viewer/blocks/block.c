// One block: its bounds, faces and openings.
#include "blocks.h"

#include "viewer/camera/vectors.h"

#include <string.h>

const char *const block_faces[BLOCK_FACES] = { "-x", "+x", "-y", "+y", "-z", "+z" };

int block_face_find(const char *name)
{
    for (int f = 0; f < BLOCK_FACES; f++)
        if (strcmp(block_faces[f], name) == 0) return f;
    return -1;
}

void block_bounds(const struct block *block, float low[3], float high[3])
{
    for (int a = 0; a < 3; a++) {
        low[a] = high[a] = block->corner[0][a];
        for (int c = 1; c < BLOCK_CORNERS; c++) {
            low[a] = fminf(low[a], block->corner[c][a]);
            high[a] = fmaxf(high[a], block->corner[c][a]);
        }
    }
}

bool block_is_box(const struct block *block)
{
    for (int c = 0; c < BLOCK_CORNERS; c++)
        for (int a = 0; a < 3; a++)
            if (block->corner[c][a] != block->corner[c >> a & 1 ? BLOCK_CORNERS - 1 : 0][a])
                return false;
    return true;
}

void block_set_box(struct block *block, const float low[3], const float high[3])
{
    for (int c = 0; c < BLOCK_CORNERS; c++)
        for (int a = 0; a < 3; a++) block->corner[c][a] = c >> a & 1 ? high[a] : low[a];
}

void block_centre(const struct block *block, float out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = 0;
        for (int c = 0; c < BLOCK_CORNERS; c++) out[a] += block->corner[c][a] / BLOCK_CORNERS;
    }
}

// Two axes of the face, in which its corners follow each other.
int block_face_corner(int face, int i)
{
    const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    return (face % 2) << axis | (i == 1 || i == 2) << u | (i >= 2) << v;
}

void block_face_centre(const struct block *block, int face, float out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = 0;
        for (int i = 0; i < 4; i++) out[a] += 0.25f * block->corner[block_face_corner(face, i)][a];
    }
}

void block_face_normal(const struct block *block, int face, float out[3])
{
    const float *corner[4];
    float a[3], b[3];
    for (int i = 0; i < 4; i++) corner[i] = block->corner[block_face_corner(face, i)];
    for (int k = 0; k < 3; k++) {
        a[k] = corner[2][k] - corner[0][k];
        b[k] = corner[3][k] - corner[1][k];
    }
    vec_cross(a, b, out);
    vec_normalize(out);
    for (int k = 0; k < 3 && face % 2 == 0; k++) out[k] = -out[k];
}

bool block_has_holes(const struct block *block, int face)
{
    if (block->neighbor[face] < 0) return false;
    for (int p = 0; p < BLOCK_HOLES; p++)
        if (block->holes[face][p] > 0.0f) return true;
    return false;
}

enum opening block_opening(const struct block *block, int face)
{
    if (block->neighbor[face] >= 0) return OPENING_NEIGHBOR;
    return block->open[face] ? OPENING_OPEN : OPENING_WALL;
}
