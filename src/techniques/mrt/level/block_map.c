// Storage, connections and checks of block maps.
#include "block_map.h"

#include "scene/scene_check.h"

#include <string.h>

// Distance of corners that meet, over the longest edge of the two faces.
static const float MEETING_TOLERANCE = 1e-3f;

bool mrt_block_map_init(struct host *host, const char *what, size_t count,
                        struct mrt_block_map *map)
{
    *map = (struct mrt_block_map){ .host = host };
    if (count > MRT_MAX_BLOCKS)
        return host_fail(host, FAIL_FORMAT, "%s: there are %zu blocks, more than %d", what, count,
                         MRT_MAX_BLOCKS);
    map->blocks = host_alloc(host, count, sizeof *map->blocks);
    if (!map->blocks) return false;
    map->count = (int)count;
    return true;
}

void mrt_block_map_finish(struct mrt_block_map *map)
{
    for (int i = 0; i < map->named_count; i++) host_free(map->host, map->named[i].node);
    if (map->host) host_free(map->host, map->named);
    if (map->host) host_free(map->host, map->blocks);
    *map = (struct mrt_block_map){ 0 };
}

bool mrt_block_map_append(const char *what, struct mrt_block_map *map, struct mrt_block_map *more)
{
    const int first = map->count;
    struct mrt_block_map both;
    if (!mrt_block_map_init(map->host, what, (size_t)first + (size_t)more->count, &both))
        return false;
    memcpy(both.blocks, map->blocks, (size_t)first * sizeof *both.blocks);
    memcpy(both.blocks + first, more->blocks, (size_t)more->count * sizeof *both.blocks);
    for (int b = first; b < both.count; b++)
        for (int f = 0; f < CUBE_FACES; f++)
            if (both.blocks[b].neighbor[f].block >= 0) both.blocks[b].neighbor[f].block += first;
    mrt_block_map_finish(more);
    host_free(map->host, map->blocks);
    map->blocks = both.blocks;
    map->count = both.count;
    return true;
}

static float longest_edge(const struct mrt_block *block, int face)
{
    float longest = 0.0f;
    for (int i = 0; i < 4; i++) {
        vec3s a = block->corner[mrt_face_corner(face, i)];
        vec3s b = block->corner[mrt_face_corner(face, (i + 1) % 4)];
        longest = glm_max(longest, glms_vec3_distance(a, b));
    }
    return longest;
}

// The number of quarter turns with which corner i of one face is corner i − rolls of the other,
// whose frame is rotated by 180° around v; −1: the faces do not meet.
static int rolls_between(const struct mrt_block *a, int face, const struct mrt_block *b, int other)
{
    float tolerance = MEETING_TOLERANCE * glm_max(longest_edge(a, face), longest_edge(b, other));
    for (int rolls = 0; rolls < 4; rolls++) {
        bool meet = true;
        for (int i = 0; i < 4 && meet; i++) {
            vec3s p = a->corner[mrt_face_corner(face, i)];
            vec3s q = b->corner[mrt_face_corner(other, (i - rolls + 4) % 4 ^ 1)];
            meet = glms_vec3_distance(p, q) <= tolerance;
        }
        if (meet) return rolls;
    }
    return -1;
}

int mrt_meeting_face(const struct mrt_block *block, int face, const struct mrt_block *other)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (rolls_between(block, face, other, f) >= 0) return f;
    return -1;
}

static bool join(const char *what, struct mrt_block_map *map, int block, int face, int other,
                 int other_face)
{
    struct mrt_block *a = &map->blocks[block], *b = &map->blocks[other];
    int rolls = block == other ? -1 : rolls_between(a, face, b, other_face);
    if (rolls < 0)
        return host_fail(map->host, FAIL_FORMAT,
                         "%s: block %s: its face %s does not meet face %s of block %s", what,
                         a->name, mrt_face_name(face), mrt_face_name(other_face), b->name);
    if (a->neighbor[face].block >= 0 || b->neighbor[other_face].block >= 0)
        return host_fail(map->host, FAIL_FORMAT,
                         "%s: block %s: its face %s or face %s of block %s has another neighbor",
                         what, a->name, mrt_face_name(face), mrt_face_name(other_face), b->name);
    a->neighbor[face] = (struct mrt_neighbor){ other, other_face, rolls };
    // Seen from the other side, u is reversed and so is the sense of the turn; so are the roles of
    // the two frames: the number of turns stays.
    b->neighbor[other_face] = (struct mrt_neighbor){ block, face, rolls };
    return true;
}

bool mrt_connect(const char *what, struct mrt_block_map *map, int block, int face, int other,
                 int other_face)
{
    if (!join(what, map, block, face, other, other_face)) return false;
    map->blocks[block].open |= 1u << face;
    map->blocks[other].open |= 1u << other_face;
    return true;
}

static void close_face(struct mrt_block *block, int face)
{
    block->neighbor[face].block = -1;
    block->open &= ~(1u << face);
    block->holes[face] = (struct mrt_holes){ 0 };
}

void mrt_disconnect(struct mrt_block_map *map, int block, int face)
{
    const struct mrt_neighbor beyond = map->blocks[block].neighbor[face];
    if (beyond.block < 0) return;
    close_face(&map->blocks[block], face);
    close_face(&map->blocks[beyond.block], beyond.face);
}

// (s, t) at corner i of a face.
static vec2s corner_place(int i)
{
    return (vec2s){ { i == 1 || i == 2 ? 1.0f : 0.0f, i >= 2 ? 1.0f : 0.0f } };
}

// Holes of a face as the other one has them, with the corners of rolls_between.
static struct mrt_holes holes_from_beyond(const struct mrt_holes *holes, int rolls)
{
    struct mrt_holes out;
    vec2s corner[4];
    for (int i = 0; i < 4; i++) corner[i] = corner_place((i - rolls + 4) % 4 ^ 1);
    for (int p = 0; p < MRT_HOLE_PARTS; p++) {
        const float s = ((float)(p % MRT_HOLES) + 0.5f) / MRT_HOLES;
        const float t = ((float)(p / MRT_HOLES) + 0.5f) / MRT_HOLES;
        vec2s at = corner[0];
        at = glms_vec2_add(at, glms_vec2_scale(glms_vec2_sub(corner[1], corner[0]), s));
        at = glms_vec2_add(at, glms_vec2_scale(glms_vec2_sub(corner[3], corner[0]), t));
        out.share[mrt_hole_part(at.x, at.y)] = holes->share[p];
    }
    return out;
}

bool mrt_connect_by_holes(const char *what, struct mrt_block_map *map, int block, int face,
                          int other, int other_face, const struct mrt_holes *holes)
{
    if (!join(what, map, block, face, other, other_face)) return false;
    map->blocks[block].holes[face] = *holes;
    map->blocks[other].holes[other_face] =
        holes_from_beyond(holes, map->blocks[block].neighbor[face].rolls);
    return true;
}

static const char *block_fault(const struct mrt_block *block)
{
    for (int c = 0; c < MRT_CORNERS; c++)
        if (!vec3_is_finite(block->corner[c])) return "a corner is not finite";
    if (mrt_warp_folds(block->corner)) return "its corners are mirrored, flat or fold over";
    if (block->kind != MRT_BLOCK_CUBE && block->open != mrt_kind_openings(block->kind))
        return "it has openings that its shape lacks";
    if (block->open == CUBE_ALL_FACES) return "it has no wall";
    return NULL;
}

bool mrt_block_map_check(const char *what, const struct mrt_block_map *map)
{
    for (int i = 0; i < map->count; i++) {
        const struct mrt_block *block = &map->blocks[i];
        const char *fault = block_fault(block);
        for (int j = 0; j < i && !fault; j++)
            if (strcmp(map->blocks[j].name, block->name) == 0) fault = "another has this name";
        if (fault)
            return host_fail(map->host, FAIL_FORMAT, "%s: block %s: %s", what, block->name, fault);
    }
    return true;
}

// ---- maps for dictionaries of the plane

float mrt_block_map_mean_edge(const struct mrt_block_map *map)
{
    double volume = 0.0;
    for (int b = 0; b < map->count; b++)
        volume += (double)glms_mat3_det(
            mrt_warp_jacobian(map->blocks[b].corner, vec3_of(0.0f, 0.0f, 0.0f)));
    return (float)cbrt(volume / map->count);
}

static bool is_in_plane(const struct mrt_block *block, int face)
{
    const struct mrt_neighbor *n = &block->neighbor[face];
    if (!mrt_block_is_open(block, face) && n->block < 0) return true;
    bool side = face / 2 != 1 && (n->block < 0 || n->face / 2 != 1);
    return side && (n->block < 0 || n->rolls == 0);
}

bool mrt_block_map_is_plane(const struct mrt_block_map *map)
{
    for (int b = 0; b < map->count; b++)
        for (int f = 0; f < CUBE_FACES; f++)
            if (!is_in_plane(&map->blocks[b], f)) return false;
    return true;
}

bool mrt_block_map_is_tunnel(const struct mrt_block_map *map)
{
    for (int b = 0; b < map->count; b++) {
        const struct mrt_block *block = &map->blocks[b];
        if (block->kind == MRT_BLOCK_CUBE) return false;
        for (int f = 0; f < CUBE_FACES; f++)
            if (block->neighbor[f].block >= 0 && block->neighbor[f].rolls != 0) return false;
    }
    return map->count > 0;
}
