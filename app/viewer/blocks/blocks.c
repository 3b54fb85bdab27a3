// Changes of a block map.
#include "blocks.h"

#include "viewer/camera/vectors.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Distance of corners that meet, over the longest edge of the two faces.
static const float MEETING_TOLERANCE = 1e-3f;
enum { MOST_PLACES = 64 };

void blocks_close(struct blocks *blocks)
{
    free(blocks->at);
    free(blocks->clutter);
    free(blocks->walls);
    *blocks = (struct blocks){ 0 };
}

static bool copy_text(char **to, const char *from)
{
    *to = from ? strdup(from) : NULL;
    return *to || !from;
}

bool blocks_copy(struct blocks *to, const struct blocks *from)
{
    const size_t bytes = (size_t)from->count * sizeof *from->at;
    *to = (struct blocks){ .count = from->count, .at = malloc(bytes + sizeof *from->at) };
    if (to->at && from->count > 0) memcpy(to->at, from->at, bytes);
    if (to->at && copy_text(&to->clutter, from->clutter) && copy_text(&to->walls, from->walls))
        return true;
    blocks_close(to);
    return false;
}

static bool same_block(const struct block *a, const struct block *b)
{
    bool same = strcmp(a->name, b->name) == 0 && strcmp(a->shape, b->shape) == 0;
    for (int f = 0; f < BLOCK_FACES; f++)
        same &= a->open[f] == b->open[f] && a->neighbor[f] == b->neighbor[f] &&
                memcmp(a->holes[f], b->holes[f], sizeof a->holes[f]) == 0;
    for (int c = 0; c < BLOCK_CORNERS; c++)
        for (int k = 0; k < 3; k++) same &= a->corner[c][k] == b->corner[c][k];
    return same;
}

bool blocks_same(const struct blocks *a, const struct blocks *b)
{
    if (a->count != b->count) return false;
    for (int i = 0; i < a->count; i++)
        if (!same_block(&a->at[i], &b->at[i])) return false;
    return true;
}

// ---- adding and removing

static bool is_taken(const struct blocks *blocks, const char *name)
{
    for (int i = 0; i < blocks->count; i++)
        if (strcmp(blocks->at[i].name, name) == 0) return true;
    return false;
}

int blocks_add(struct blocks *blocks, const struct block *block)
{
    struct block added = *block; // `block` may be one of them
    if (blocks->count >= BLOCKS_MOST) return -1;
    struct block *at = realloc(blocks->at, ((size_t)blocks->count + 1) * sizeof *at);
    if (!at) return -1;
    blocks->at = at;
    for (int number = blocks->count; !added.name[0] || is_taken(blocks, added.name); number++)
        snprintf(added.name, sizeof added.name, "block %d", number);
    for (int f = 0; f < BLOCK_FACES; f++) added.neighbor[f] = -1;
    at[blocks->count] = added;
    return blocks->count++;
}

int blocks_extend(struct blocks *blocks, int block, int face)
{
    const struct block *from = &blocks->at[block];
    struct block beyond = { .shape = "cube" };
    if (from->neighbor[face] >= 0) return -1;
    const int axis = face / 2, bit = 1 << axis;
    for (int c = 0; c < BLOCK_CORNERS; c++) {
        const bool is_far = (c >> axis & 1) == face % 2;
        const float *near = from->corner[face % 2 ? c | bit : c & ~bit];
        const float *back = from->corner[face % 2 ? c & ~bit : c | bit];
        for (int k = 0; k < 3; k++)
            beyond.corner[c][k] = is_far ? 2.0f * near[k] - back[k] : near[k];
    }
    const int added = blocks_add(blocks, &beyond);
    if (added >= 0) blocks_set_opening(blocks, block, face, OPENING_NEIGHBOR);
    return added;
}

void blocks_remove(struct blocks *blocks, int block)
{
    for (int i = 0; i < blocks->count; i++)
        for (int f = 0; f < BLOCK_FACES; f++) {
            int *neighbor = &blocks->at[i].neighbor[f];
            if (*neighbor == block) *neighbor = -1;
            if (*neighbor > block) --*neighbor;
        }
    blocks->count--;
    memmove(blocks->at + block, blocks->at + block + 1,
            (size_t)(blocks->count - block) * sizeof *blocks->at);
}

// ---- faces that meet

static float longest_edge(const struct block *block, int face)
{
    float longest = 0;
    for (int i = 0; i < 4; i++) {
        const float *a = block->corner[block_face_corner(face, i)];
        const float *b = block->corner[block_face_corner(face, (i + 1) % 4)];
        const float edge[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
        longest = fmaxf(longest, vec_length(edge));
    }
    return longest;
}

// The corner of another face at a point; -1: none.
static int corner_at(const struct block *block, int face, const float point[3], float tolerance)
{
    for (int i = 0; i < 4; i++) {
        const int c = block_face_corner(face, i);
        float to[3];
        for (int k = 0; k < 3; k++) to[k] = block->corner[c][k] - point[k];
        if (vec_length(to) <= tolerance) return c;
    }
    return -1;
}

// Whether two faces have the same corners and look at each other; to[i]: the corner of `b` at
// corner i of the face of `a`.
static bool faces_meet(const struct block *a, int face, const struct block *b, int other, int to[4])
{
    const float longest = fmaxf(longest_edge(a, face), longest_edge(b, other));
    float normal[3], opposite[3];
    unsigned met = 0;
    for (int i = 0; i < 4; i++) {
        const float *point = a->corner[block_face_corner(face, i)];
        to[i] = corner_at(b, other, point, MEETING_TOLERANCE * longest);
        if (to[i] < 0 || met & 1u << to[i]) return false;
        met |= 1u << to[i];
    }
    block_face_normal(a, face, normal);
    block_face_normal(b, other, opposite);
    return vec_dot(normal, opposite) < 0;
}

static int meeting_face(const struct blocks *blocks, int block, int face, int other, int to[4])
{
    for (int f = 0; f < BLOCK_FACES && other != block; f++)
        if (faces_meet(&blocks->at[block], face, &blocks->at[other], f, to)) return f;
    return -1;
}

// The face of the neighbour that leads back; -1: none does.
static int face_back(const struct blocks *blocks, int block, int face, int to[4])
{
    const int other = blocks->at[block].neighbor[face];
    const int back = meeting_face(blocks, block, face, other, to);
    return back >= 0 && blocks->at[other].neighbor[back] == block ? back : -1;
}

int blocks_meeting(const struct blocks *blocks, int block, int face)
{
    int to[4];
    for (int other = 0; other < blocks->count; other++) {
        const int f = meeting_face(blocks, block, face, other, to);
        const int beyond = f < 0 ? -1 : blocks->at[other].neighbor[f];
        if (f >= 0 && (beyond < 0 || beyond == block)) return other;
    }
    return -1;
}

// ---- openings

static void close_face(struct blocks *blocks, int block, int face)
{
    struct block *it = &blocks->at[block];
    const int other = it->neighbor[face];
    it->neighbor[face] = -1;
    it->open[face] = false;
    memset(it->holes[face], 0, sizeof it->holes[face]);
    for (int f = 0; f < BLOCK_FACES && other >= 0; f++)
        if (blocks->at[other].neighbor[f] == block) {
            int to[4];
            const int meets = meeting_face(blocks, block, face, other, to);
            if (meets >= 0 && meets != f) continue; // another connection of the two
            blocks->at[other].neighbor[f] = -1;
            blocks->at[other].open[f] = false;
            memset(blocks->at[other].holes[f], 0, sizeof blocks->at[other].holes[f]);
        }
}

bool blocks_set_opening(struct blocks *blocks, int block, int face, enum opening opening)
{
    struct block *it = &blocks->at[block];
    const bool cube = strcmp(it->shape, "cube") == 0;
    int to[4];
    if (opening == block_opening(it, face)) return true;
    const int other = opening == OPENING_NEIGHBOR ? blocks_meeting(blocks, block, face) : -1;
    if (opening == OPENING_NEIGHBOR && other < 0) return false;
    if (!cube && opening == OPENING_OPEN) return false;
    close_face(blocks, block, face);
    it->open[face] = opening == OPENING_OPEN;
    if (other < 0) return true;
    const int back = meeting_face(blocks, block, face, other, to);
    it->neighbor[face] = other;
    blocks->at[other].neighbor[back] = block;
    blocks->at[other].open[back] = false;
    return true;
}

int blocks_disconnect(struct blocks *blocks)
{
    int count = 0, to[4];
    for (int i = 0; i < blocks->count; i++)
        for (int f = 0; f < BLOCK_FACES; f++) {
            struct block *it = &blocks->at[i];
            if (it->neighbor[f] < 0 || face_back(blocks, i, f, to) >= 0) continue;
            close_face(blocks, i, f);
            count++;
        }
    return count;
}

// ---- corners

struct place {
    int block, corner;
};

static int add_place(struct place *places, int count, struct place place)
{
    for (int i = 0; i < count; i++)
        if (places[i].block == place.block && places[i].corner == place.corner) return count;
    if (count < MOST_PLACES) places[count++] = place;
    return count;
}

// Adds the corners of the neighbours at the same point.
static int add_beyond(const struct blocks *blocks, struct place from, struct place *places,
                      int count)
{
    for (int f = 0; f < BLOCK_FACES; f++) {
        int to[4];
        const int other = blocks->at[from.block].neighbor[f];
        if (other < 0 || face_back(blocks, from.block, f, to) < 0) continue;
        for (int i = 0; i < 4; i++)
            if (block_face_corner(f, i) == from.corner)
                count = add_place(places, count, (struct place){ other, to[i] });
    }
    return count;
}

void blocks_move_corner(struct blocks *blocks, int block, int corner, const float to[3])
{
    struct place places[MOST_PLACES] = { { block, corner } };
    int count = 1;
    for (int i = 0; i < count; i++) count = add_beyond(blocks, places[i], places, count);
    for (int i = 0; i < count; i++)
        memcpy(blocks->at[places[i].block].corner[places[i].corner], to, 3 * sizeof *to);
}

void blocks_move_face(struct blocks *blocks, int block, int face, const float by[3])
{
    float corner[BLOCK_CORNERS][3];
    int to[4];
    struct block *it = &blocks->at[block];
    const int back = it->neighbor[face] < 0 ? -1 : face_back(blocks, block, face, to);
    memcpy(corner, it->corner, sizeof corner);
    for (int i = 0; i < 4; i++) {
        const int c = block_face_corner(face, i);
        for (int k = 0; k < 3; k++) corner[c][k] += by[k];
        if (back >= 0)
            memcpy(blocks->at[it->neighbor[face]].corner[to[i]], corner[c], sizeof corner[c]);
    }
    memcpy(it->corner, corner, sizeof it->corner);
}

void blocks_shift(struct blocks *blocks, int block, const float by[3])
{
    for (int c = 0; c < BLOCK_CORNERS; c++)
        for (int k = 0; k < 3; k++) blocks->at[block].corner[c][k] += by[k];
}

void blocks_move_joined(struct blocks *blocks, int block, int face, const float by[3])
{
    for (int i = 0; i < 4; i++) {
        const int c = block_face_corner(face, i);
        float to[3];
        vec_along(blocks->at[block].corner[c], 1.0f, by, to);
        blocks_move_corner(blocks, block, c, to);
    }
}
