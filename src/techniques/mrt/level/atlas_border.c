// Borders of the tiles of the light map.
//
// Bilinear lookup on an edge is the mean of the texels on both sides, so a border texel is the
// first texel beyond the edge. A corner of a tile is harder: several walls meet in the vertex. Let
// walls 0 … m − 1 follow each other around it, each continued by the next, with their texels v_j at
// the vertex and v_−1 = v_0, v_m = v_m−1, as borders repeat the ends. Both sides of the edge
// between j and j + 1 agree if v_j−1 + c_j = v_j+2 + c_j+1 for the corners c of the borders, which
// leaves one constant: the mean of the c is that of the v. Four walls that close around the vertex
// have the opposite texel as their corner.
#include "atlas.h"

#include "techniques/mrt/level/wall.h"

enum { MAX_WALLS = MRT_BORDER_SOURCES };
static const float COPLANAR = 0.866f; // cosine of 30 degrees

static bool is_coplanar(const struct mrt_block *a, int face, const struct mrt_block *b, int other,
                        const int corner_a[2], const int corner_b[2])
{
    vec3s middle[2] = { { { 0 } }, { { 0 } } };
    for (int k = 0; k < 2; k++) {
        for (int axis = 0; axis < 3; axis++) {
            middle[0].raw[axis] += corner_a[k] >> axis & 1 ? 0.25f : -0.25f;
            middle[1].raw[axis] += corner_b[k] >> axis & 1 ? 0.25f : -0.25f;
        }
    }
    return glms_vec3_dot(mrt_warp_face_normal(a->corner, face, middle[0]),
                         mrt_warp_face_normal(b->corner, other, middle[1])) >= COPLANAR;
}

bool mrt_wall_continues(const struct mrt_block_map *map, struct mrt_wall_corner from, bool forward,
                        struct mrt_wall_corner *to)
{
    const struct mrt_block *a = &map->blocks[from.block];
    int edge = forward ? from.corner : (from.corner + 3) % 4;
    int opening = mrt_face_across_edge(from.face, edge);
    const struct mrt_neighbor *n = &a->neighbor[opening];
    if (!mrt_block_is_open(a, opening) || n->block < 0) return false;
    // The vertex first.
    int here[2] = { mrt_face_corner(from.face, from.corner),
                    mrt_face_corner(from.face, (from.corner + (forward ? 1 : 3)) % 4) };
    int there[2];
    for (int k = 0; k < 2; k++) there[k] = mrt_neighbor_corner(a, opening, here[k]);
    const struct mrt_block *b = &map->blocks[n->block];
    int face = mrt_neighbor_direction(a, opening, from.face);
    if (mrt_block_is_open(b, face) || !is_coplanar(a, from.face, b, face, here, there))
        return false;
    *to = (struct mrt_wall_corner){ n->block, face, mrt_face_corner_index(face, there[0]) };
    return true;
}

// ---- texels of a tile

// Texel i (0 … n − 1) along the edge from corner `edge` to the next: `outside` texels beyond it.
static void edge_texel(int n, int edge, int i, int outside, int *x, int *y)
{
    int across = edge == 0 || edge == 3 ? -outside : n - 1 + outside;
    int along = edge < 2 ? i : n - 1 - i;
    *x = edge % 2 ? across : along;
    *y = edge % 2 ? along : across;
}

static uint32_t level_texel(const struct mrt_atlas *atlas, int block, int face, int x, int y)
{
    const struct mrt_tile *tile = &atlas->tiles[atlas->tile_of_face[CUBE_FACES * block + face]];
    return (uint32_t)(tile->first_texel + y * atlas->resolution + x);
}

// The texel of a wall at one of its corners.
static uint32_t corner_texel(const struct mrt_atlas *atlas, struct mrt_wall_corner at)
{
    int x, y;
    edge_texel(atlas->resolution, at.corner, 0, 0, &x, &y);
    return level_texel(atlas, at.block, at.face, x, y);
}

static uint32_t atlas_texel(const struct mrt_atlas *atlas, const struct mrt_tile *tile, int x,
                            int y)
{
    return (uint32_t)((tile->y + y) * atlas->width + tile->x + x);
}

static void make_edge(const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                      const struct mrt_tile *tile, int edge, struct mrt_border *out)
{
    int n = atlas->resolution;
    struct mrt_wall_corner beyond;
    bool continues = mrt_wall_continues(
        map, (struct mrt_wall_corner){ tile->block, tile->face, edge }, true, &beyond);
    for (int i = 0; i < n; i++) {
        int x, y;
        edge_texel(n, edge, i, 1, &x, &y);
        out[i] = (struct mrt_border){ .texel = atlas_texel(atlas, tile, x, y), .count = 1 };
        out[i].weight[0] = 1.0f;
        edge_texel(n, edge, i, 0, &x, &y);
        out[i].source[0] = level_texel(atlas, tile->block, tile->face, x, y);
        if (!continues) continue;
        // Edges run counter-clockwise on both walls: the other way round.
        edge_texel(n, (beyond.corner + 3) % 4, n - 1 - i, 0, &x, &y);
        out[i].source[0] = level_texel(atlas, beyond.block, beyond.face, x, y);
    }
}

// ---- corners

struct walls {
    struct mrt_wall_corner wall[MAX_WALLS];
    int count, own; // own: index of the wall whose corner is made
    bool closed;
};

static bool same_wall(struct mrt_wall_corner a, struct mrt_wall_corner b)
{
    return a.block == b.block && a.face == b.face;
}

// False: more walls than fit.
static bool walls_around(const struct mrt_block_map *map, struct mrt_wall_corner own,
                         struct walls *out)
{
    struct mrt_wall_corner at = own, next;
    *out = (struct walls){ .count = 0 };
    while (mrt_wall_continues(map, at, false, &next) && !out->closed) {
        at = next;
        out->closed = same_wall(at, own);
        if (++out->own == MAX_WALLS) return false;
    }
    if (out->closed) out->own = 0;
    do {
        if (out->count == MAX_WALLS) return false;
        out->wall[out->count++] = at;
    } while (mrt_wall_continues(map, at, true, &at) && !(out->closed && same_wall(at, own)));
    return true;
}

// c_j as weights of the v, with c_0 = 0.
static void chain_corner(int count, int j, float weight[MAX_WALLS])
{
    for (int k = 0; k < count; k++) weight[k] = 0.0f;
    for (int k = 0; k < j; k++) {
        weight[k > 0 ? k - 1 : 0] += 1.0f;
        weight[k + 2 < count ? k + 2 : count - 1] -= 1.0f;
    }
}

static void corner_weights(const struct walls *walls, float weight[MAX_WALLS])
{
    float share = 1.0f / (float)walls->count, c[MAX_WALLS];
    if (walls->closed) {
        for (int k = 0; k < walls->count; k++)
            weight[k] = walls->count == 4 ? (float)(k == 2) : share;
        return;
    }
    chain_corner(walls->count, walls->own, weight);
    for (int j = 0; j < walls->count; j++) {
        chain_corner(walls->count, j, c);
        for (int k = 0; k < walls->count; k++) weight[k] -= share * c[k];
    }
    for (int k = 0; k < walls->count; k++) weight[k] += share;
}

static void make_corner(const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                        const struct mrt_tile *tile, int corner, struct mrt_border *out)
{
    int n = atlas->resolution;
    struct mrt_wall_corner own = { tile->block, tile->face, corner };
    struct walls walls;
    float weight[MAX_WALLS];
    int x = corner == 0 || corner == 3 ? -1 : n, y = corner < 2 ? -1 : n;
    if (!walls_around(map, own, &walls)) walls = (struct walls){ { own }, 1, 0, false };
    corner_weights(&walls, weight);
    *out = (struct mrt_border){ .texel = atlas_texel(atlas, tile, x, y) };
    for (int k = 0; k < walls.count; k++) {
        if (weight[k] == 0.0f) continue;
        out->source[out->count] = corner_texel(atlas, walls.wall[k]);
        out->weight[out->count++] = weight[k];
    }
}

// ---- tubes

// The texel of a tube beside its end at a point of the end's edge: another tube's, or its own.
static uint32_t end_texel(const struct mrt_atlas *atlas, const struct mrt_block_map *map, int block,
                          int face, vec3s edge)
{
    const int n = atlas->resolution;
    const enum tube_bend bend = mrt_block_bend(&map->blocks[block]);
    const int x = (int)(tube_locate(bend, edge).around * (float)n) % n;
    return level_texel(atlas, block, 0, x, face == CUBE_BACK ? 0 : n - 1);
}

static uint32_t texel_beyond(const struct mrt_atlas *atlas, const struct mrt_block_map *map,
                             int block, int face, int x)
{
    const struct mrt_block *own = &map->blocks[block];
    const struct mrt_neighbor *n = &own->neighbor[face];
    vec3s edge = tube_wall(mrt_block_bend(own), ((float)x + 0.5f) / (float)atlas->resolution,
                           face == CUBE_BACK ? 0.0f : 1.0f);
    vec3s there;
    if (n->block < 0 || !mrt_block_is_tube(&map->blocks[n->block]) ||
        !mrt_warp_inverse(map->blocks[n->block].corner, mrt_warp_point(own->corner, edge), &there))
        return end_texel(atlas, map, block, face, edge);
    return end_texel(atlas, map, n->block, n->face, there);
}

static int exit_of(const struct mrt_block *tube)
{
    for (int f = 0; f < CUBE_FACES; f++)
        if (f != CUBE_BACK && mrt_block_is_open(tube, f)) return f;
    return -1;
}

// The border continues around the tube, and along it into its neighbours.
static void make_tube(const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                      const struct mrt_tile *tile, struct mrt_border *out)
{
    const int n = atlas->resolution, exit = exit_of(&map->blocks[tile->block]);
    for (int y = -1; y <= n; y++)
        for (int x = -1; x <= n; x++) {
            const int around = (x + n) % n;
            if (x >= 0 && x < n && y >= 0 && y < n) continue;
            *out = (struct mrt_border){ .texel = atlas_texel(atlas, tile, x, y), .count = 1 };
            out->weight[0] = 1.0f;
            out->source[0] = y >= 0 && y < n ? level_texel(atlas, tile->block, 0, around, y)
                                             : texel_beyond(atlas, map, tile->block,
                                                            y < 0 ? CUBE_BACK : exit, around);
            out++;
        }
}

void mrt_atlas_make_borders(const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                            int tile, struct mrt_border *out)
{
    int n = atlas->resolution;
    if (mrt_block_is_tube(&map->blocks[atlas->tiles[tile].block])) {
        make_tube(map, atlas, &atlas->tiles[tile], out);
        return;
    }
    for (int k = 0; k < 4; k++) {
        make_edge(map, atlas, &atlas->tiles[tile], k, out + k * n);
        make_corner(map, atlas, &atlas->tiles[tile], k, out + 4 * n + k);
    }
}
