// A grid over all blocks; each cell lists the blocks whose bounds, with a margin, touch it.
#include "techniques/mrt/gpu/upload.h"

#include <math.h>

// Margin of a block over its bounds: surfaces outside still belong to the nearest block (MRT_BEYOND
// in locate.glsl).
static const float MARGIN = 1.0f;
static const float OFFSET = 0.01f; // of the shortest edge: lookups along the normal

struct grid {
    vec3s origin;
    float cell;
    int cells[3];
};

static struct box3 bounds_of(const struct mrt_block *block, float margin)
{
    const struct box3 box = mrt_warp_bounds(block->corner);
    vec3s more = glms_vec3_scale(box3_size(box), margin);
    return (struct box3){ glms_vec3_sub(box.min, more), glms_vec3_add(box.max, more) };
}

static struct grid grid_of(const struct mrt_block_map *map)
{
    struct box3 all = box3_empty();
    for (int b = 0; b < map->count; b++) {
        all = box3_union(all, bounds_of(&map->blocks[b], MARGIN));
    }
    vec3s size = box3_size(all);
    struct grid grid = { .origin = all.min, .cell = glms_vec3_max(size) / (float)MRT_LOOKUP_CELLS };
    for (int a = 0; a < 3; a++) grid.cells[a] = (int)fmaxf(ceilf(size.raw[a] / grid.cell), 1.0f);
    return grid;
}

static int clamp_cell(float x, int cells)
{
    return (int)fminf(fmaxf(floorf(x), 0.0f), (float)(cells - 1));
}

struct lists {
    uint32_t (*cell)[2]; // first candidate, count
    uint32_t *candidates;
};

// Counts the blocks that touch each cell, and lists them where there are candidates.
static void add_blocks(const struct grid *grid, const struct mrt_block_map *map,
                       struct lists *lists)
{
    for (int b = 0; b < map->count; b++) {
        const struct box3 box = bounds_of(&map->blocks[b], MARGIN);
        int low[3], high[3];
        for (int a = 0; a < 3; a++) {
            const float origin = grid->origin.raw[a];
            low[a] = clamp_cell((box.min.raw[a] - origin) / grid->cell, grid->cells[a]);
            high[a] = clamp_cell((box.max.raw[a] - origin) / grid->cell, grid->cells[a]);
        }
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    uint32_t *cell = lists->cell[(z * grid->cells[1] + y) * grid->cells[0] + x];
                    if (lists->candidates) lists->candidates[cell[0] + cell[1]] = (uint32_t)b;
                    cell[1]++;
                }
    }
}

// First candidates from the counts, which become 0. Returns the number of candidates.
static size_t place_lists(struct lists *lists, size_t cells)
{
    size_t total = 0;
    for (size_t i = 0; i < cells; i++) {
        lists->cell[i][0] = (uint32_t)total;
        total += lists->cell[i][1];
        lists->cell[i][1] = 0;
    }
    return total;
}

// The shortest distance from the middle of a block to that of a wall, twice.
static float shortest_edge(const struct mrt_block_map *map)
{
    float least = INFINITY;
    for (int b = 0; b < map->count; b++) {
        mat3s j = mrt_warp_jacobian(map->blocks[b].corner, vec3_of(0, 0, 0));
        for (int a = 0; a < 3; a++) least = fminf(least, glms_vec3_norm(j.col[a]));
    }
    return least;
}

static void set_params(struct mrt_level_params *level, const struct grid *grid,
                       const struct mrt_block_map *map)
{
    level->grid_origin_m = grid->origin;
    level->cells_per_m = 1.0f / grid->cell;
    level->cells_x = grid->cells[0];
    level->cells_y = grid->cells[1];
    level->cells_z = grid->cells[2];
    level->offset_m = OFFSET * shortest_edge(map);
}

static float distance_to(const struct mrt_block *block, vec3s point)
{
    struct box3 box = bounds_of(block, 0.0f);
    vec3s below = glms_vec3_sub(box.min, point), above = glms_vec3_sub(point, box.max);
    return glms_vec3_norm(glms_vec3_maxv(glms_vec3_maxv(below, above), vec3_of(0, 0, 0)));
}

// The block nearest to the cell's middle first: most searches end with it.
static void place_nearest_first(const struct grid *grid, const struct mrt_block_map *map,
                                size_t cell, uint32_t *candidates, uint32_t count)
{
    const size_t x = (size_t)grid->cells[0], y = (size_t)grid->cells[1];
    vec3s middle = vec3_of((float)(cell % x), (float)(cell / x % y), (float)(cell / (x * y)));
    middle = glms_vec3_muladds(glms_vec3_adds(middle, 0.5f), grid->cell, grid->origin);
    float least = INFINITY;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t block = candidates[i];
        const float distance = distance_to(&map->blocks[block], middle);
        if (distance >= least) continue;
        least = distance;
        candidates[i] = candidates[0];
        candidates[0] = block;
    }
}

bool mrt_lookup_grid_upload(struct mrt_runtime *runtime, const struct mrt_block_map *map)
{
    struct grid grid = grid_of(map);
    struct lists lists = { 0 };
    size_t cells = (size_t)grid.cells[0] * (size_t)grid.cells[1] * (size_t)grid.cells[2];
    bool ok = false;
    set_params(&runtime->level, &grid, map);
    lists.cell = host_alloc(runtime->host, cells, sizeof *lists.cell);
    if (!lists.cell) return false;
    add_blocks(&grid, map, &lists);
    size_t total = place_lists(&lists, cells);
    lists.candidates = host_alloc(runtime->host, total, sizeof *lists.candidates);
    if (!lists.candidates) goto done;
    add_blocks(&grid, map, &lists);
    for (size_t i = 0; i < cells; i++)
        place_nearest_first(&grid, map, i, lists.candidates + lists.cell[i][0], lists.cell[i][1]);
    ok = mrt_buffer_of(runtime, "mrt_cells", lists.cell, cells * sizeof *lists.cell) &&
         mrt_buffer_of(runtime, "mrt_candidates", lists.candidates,
                       total * sizeof *lists.candidates);
done:
    host_free(runtime->host, lists.cell);
    host_free(runtime->host, lists.candidates);
    return ok;
}
