#include "block_grid.h"

#include <math.h>

static struct box3 bounds_of(const struct mrt_block *block, float margin)
{
    const struct box3 box = mrt_warp_bounds(block->corner);
    vec3s more = glms_vec3_scale(box3_size(box), margin);
    return (struct box3){ glms_vec3_sub(box.min, more), glms_vec3_add(box.max, more) };
}

static size_t cells_of(const struct mrt_block_grid *grid)
{
    return (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
}

static void place_grid(struct mrt_block_grid *grid, const struct mrt_block_map *map, float margin,
                       int cells)
{
    struct box3 all = box3_empty();
    for (int b = 0; b < map->count; b++) all = box3_union(all, bounds_of(&map->blocks[b], margin));
    vec3s size = box3_size(all);
    grid->origin_m = all.min;
    grid->cell_m = glms_vec3_max(size) / (float)cells;
    for (int a = 0; a < 3; a++)
        grid->cells[a] = (int)fmaxf(ceilf(size.raw[a] / grid->cell_m), 1.0f);
}

static int clamp_cell(float x, int cells)
{
    return (int)fminf(fmaxf(floorf(x), 0.0f), (float)(cells - 1));
}

// Counts the blocks that touch each cell, and lists them where there are candidates.
static void add_blocks(struct mrt_block_grid *grid, const struct mrt_block_map *map, float margin)
{
    if (map->is_open) return;
    for (int b = 0; b < map->count; b++) {
        const struct box3 box = bounds_of(&map->blocks[b], margin);
        int low[3], high[3];
        for (int a = 0; a < 3; a++) {
            const float origin = grid->origin_m.raw[a];
            low[a] = clamp_cell((box.min.raw[a] - origin) / grid->cell_m, grid->cells[a]);
            high[a] = clamp_cell((box.max.raw[a] - origin) / grid->cell_m, grid->cells[a]);
        }
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    struct mrt_block_list *list =
                        &grid->lists[(z * grid->cells[1] + y) * grid->cells[0] + x];
                    if (grid->candidates) grid->candidates[list->first + list->count] = (uint32_t)b;
                    list->count++;
                }
    }
}

// First candidates from the counts, which become 0. Returns the number of candidates.
static size_t place_lists(struct mrt_block_grid *grid)
{
    size_t total = 0;
    for (size_t i = 0; i < cells_of(grid); i++) {
        grid->lists[i].first = (uint32_t)total;
        total += grid->lists[i].count;
        grid->lists[i].count = 0;
    }
    return total;
}

static float distance_to(const struct mrt_block *block, vec3s point)
{
    struct box3 box = bounds_of(block, 0.0f);
    vec3s below = glms_vec3_sub(box.min, point), above = glms_vec3_sub(point, box.max);
    return glms_vec3_norm(glms_vec3_maxv(glms_vec3_maxv(below, above), vec3_of(0, 0, 0)));
}

// Most searches end with the nearest block.
static void place_nearest_first(struct mrt_block_grid *grid, const struct mrt_block_map *map,
                                size_t cell)
{
    const size_t x = (size_t)grid->cells[0], y = (size_t)grid->cells[1];
    const struct mrt_block_list list = grid->lists[cell];
    uint32_t *candidates = grid->candidates + list.first;
    vec3s middle = vec3_of((float)(cell % x), (float)(cell / x % y), (float)(cell / (x * y)));
    middle = glms_vec3_muladds(glms_vec3_adds(middle, 0.5f), grid->cell_m, grid->origin_m);
    float least = INFINITY;
    for (uint32_t i = 0; i < list.count; i++) {
        const uint32_t block = candidates[i];
        const float distance = distance_to(&map->blocks[block], middle);
        if (distance >= least) continue;
        least = distance;
        candidates[i] = candidates[0];
        candidates[0] = block;
    }
}

bool mrt_block_grid_init(struct host *host, const struct mrt_block_map *map, float margin,
                         int cells, struct mrt_block_grid *out)
{
    *out = (struct mrt_block_grid){ .host = host, .map = map };
    place_grid(out, map, margin, cells);
    out->lists = host_alloc(host, cells_of(out), sizeof *out->lists);
    if (!out->lists) return false;
    add_blocks(out, map, margin);
    const size_t candidates = place_lists(out);
    out->candidate_count = candidates > 0 ? candidates : 1; // of an open map: one that no list has
    out->candidates = host_alloc(host, out->candidate_count, sizeof *out->candidates);
    if (!out->candidates) {
        mrt_block_grid_finish(out);
        return false;
    }
    add_blocks(out, map, margin);
    for (size_t i = 0; i < cells_of(out); i++) place_nearest_first(out, map, i);
    return true;
}

void mrt_block_grid_finish(struct mrt_block_grid *grid)
{
    if (!grid->host) return;
    host_free(grid->host, grid->lists);
    host_free(grid->host, grid->candidates);
    *grid = (struct mrt_block_grid){ 0 };
}

struct mrt_block_list mrt_blocks_near(const struct mrt_block_grid *grid, vec3s point)
{
    int at[3];
    for (int a = 0; a < 3; a++) {
        const float cell = floorf((point.raw[a] - grid->origin_m.raw[a]) / grid->cell_m);
        if (!(cell >= 0.0f && cell < (float)grid->cells[a])) return (struct mrt_block_list){ 0 };
        at[a] = (int)cell;
    }
    return grid->lists[(at[2] * grid->cells[1] + at[1]) * grid->cells[0] + at[0]];
}

bool mrt_is_in_a_block(const struct mrt_block_grid *grid, vec3s point)
{
    const struct mrt_block_list list = mrt_blocks_near(grid, point);
    for (uint32_t k = 0; k < list.count; k++) {
        const struct mrt_block *block = &grid->map->blocks[grid->candidates[list.first + k]];
        vec3s cell;
        if (mrt_warp_inverse(block->corner, point, &cell) &&
            glms_vec3_max(glms_vec3_abs(cell)) <= MRT_IN_CELL)
            return true;
    }
    return false;
}

float mrt_shortest_edge(const struct mrt_block_map *map)
{
    float least = INFINITY;
    for (int b = 0; b < map->count; b++) {
        mat3s j = mrt_warp_jacobian(map->blocks[b].corner, vec3_of(0, 0, 0));
        for (int a = 0; a < 3; a++) least = fminf(least, glms_vec3_norm(j.col[a]));
    }
    return least;
}
