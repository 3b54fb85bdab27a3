// Positions of the probes of a level.
#include "probes.h"

#include "techniques/mrt/level/wall.h"

#include <math.h>

static vec3s cell_of(int per_edge, int count, int i, int border)
{
    vec3s at =
        vec3_of((float)(i % count), (float)(i / count % count), (float)(i / (count * count)));
    at = glms_vec3_divs(glms_vec3_adds(at, 0.5f - (float)border), (float)per_edge);
    return glms_vec3_subs(at, 0.5f);
}

vec3s mrt_probe_cell(int p, int i)
{
    return cell_of(p, p, i, 0);
}

vec3s mrt_probe_position(const struct mrt_block *block, int p, int i)
{
    vec3s cell = mrt_probe_cell(p, i);
    if (mrt_block_is_tube(block))
        cell = tube_inside(mrt_block_bend(block), glms_vec3_adds(cell, 0.5f));
    return mrt_warp_point(block->corner, cell);
}

// Newton's iteration of the polar decomposition: Q ← (Q + Q⁻ᵀ) / 2 (Higham 1986).
mat3s mrt_block_rotation(const struct mrt_block *block)
{
    enum { STEPS = 24 };
    mat3s q = mrt_warp_jacobian(block->corner, vec3_of(0, 0, 0));
    // The scale does not matter to the result, but to the number of steps.
    float scale = cbrtf(fabsf(glms_mat3_det(q)));
    for (int c = 0; c < 3; c++) q.col[c] = glms_vec3_divs(q.col[c], scale);
    for (int i = 0; i < STEPS; i++) {
        mat3s inverse = glms_mat3_transpose(glms_mat3_inv(q));
        for (int c = 0; c < 3; c++)
            q.col[c] = glms_vec3_scale(glms_vec3_add(q.col[c], inverse.col[c]), 0.5f);
    }
    return q;
}

// The opening with a block behind it by which a point is farthest outside; −1: none.
static int opening_towards(const struct mrt_block *block, vec3s cell)
{
    static const float INSIDE = 0.5f + 1e-4f;
    int face = -1;
    float most = INSIDE;
    for (int a = 0; a < 3; a++) {
        int f = 2 * a + (cell.raw[a] > 0.0f);
        if (!(fabsf(cell.raw[a]) > most) || mrt_block_beyond(block, f) < 0) continue;
        most = fabsf(cell.raw[a]);
        face = f;
    }
    return face;
}

static int nearest_probe(int p, vec3s cell)
{
    int at[3];
    for (int a = 0; a < 3; a++)
        at[a] = (int)fminf(fmaxf(floorf((cell.raw[a] + 0.5f) * (float)p), 0.0f), (float)(p - 1));
    return (at[2] * p + at[1]) * p + at[0];
}

static int nearest_position(const struct mrt_block *block, int p, vec3s world)
{
    int nearest = 0;
    float least = INFINITY;
    for (int i = 0; i < mrt_probes_of_block(p); i++) {
        float distance = glms_vec3_distance2(mrt_probe_position(block, p, i), world);
        if (!(distance < least)) continue;
        least = distance;
        nearest = i;
    }
    return nearest;
}

// Beyond an end of a tube: the probe of the neighbour that is nearest to the same place of the end.
static int probe_of_tube(const struct mrt_block_map *map, int p, int b, vec3s unit)
{
    const struct mrt_block *block = &map->blocks[b];
    const bool before = unit.z<0.0f, after = unit.z> 1.0f;
    int beyond = -1;
    for (int f = 0; f < CUBE_FACES && (before || after); f++)
        if (mrt_block_is_open(block, f) && (f == CUBE_BACK) == before)
            beyond = block->neighbor[f].block;
    if (beyond < 0)
        return b * mrt_probes_of_block(p) + nearest_probe(p, glms_vec3_subs(unit, 0.5f));
    const float half = 0.5f / (float)p;
    for (int a = 0; a < 2; a++) unit.raw[a] = fminf(fmaxf(unit.raw[a], half), 1.0f - half);
    unit.z = after ? 1.0f : 0.0f;
    const vec3s end = mrt_warp_point(block->corner, tube_inside(mrt_block_bend(block), unit));
    return beyond * mrt_probes_of_block(p) + nearest_position(&map->blocks[beyond], p, end);
}

// Walks through at most one opening for each axis.
int mrt_probe_of_brick_texel(const struct mrt_block_map *map, int p, int block, int i)
{
    if (mrt_block_is_tube(&map->blocks[block]))
        return probe_of_tube(map, p, block, glms_vec3_adds(cell_of(p, p + 2, i, 1), 0.5f));
    vec3s cell = cell_of(p, p + 2, i, 1);
    vec3s world = mrt_warp_point(map->blocks[block].corner, cell);
    for (int step = 0; step < 3; step++) {
        int face = opening_towards(&map->blocks[block], cell);
        vec3s beyond;
        if (face < 0) break;
        int next = map->blocks[block].neighbor[face].block;
        if (!mrt_warp_inverse(map->blocks[next].corner, world, &beyond)) break;
        block = next;
        cell = beyond;
    }
    return block * mrt_probes_of_block(p) + nearest_probe(p, cell);
}
