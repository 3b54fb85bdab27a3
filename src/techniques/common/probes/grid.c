#include "techniques/common/probes/grid.h"

#include <math.h>
#include <string.h>

struct frame_probes probe_grid_of_one(void)
{
    return (struct frame_probes){
        .spacing_m = 1.0f, .count_x = 1, .count_y = 1, .count_z = 1, .slab = 1
    };
}

struct frame_probes probe_grid_over(struct box3 box, float spacing_m)
{
    struct frame_probes grid = { .first_m = box.min, .spacing_m = spacing_m };
    const vec3s size = box3_size(box);
    int32_t *const counts[3] = { &grid.count_x, &grid.count_y, &grid.count_z };
    for (int a = 0; a < 3; a++) {
        *counts[a] = (int32_t)fmaxf(ceilf(size.raw[a] / spacing_m - 1e-3f), 1.0f);
        grid.first_m.raw[a] += 0.5f * (size.raw[a] - spacing_m * (float)(*counts[a] - 1));
    }
    grid.slab = grid.count_z;
    return grid;
}

// ---- around surfaces

enum { MOST_PROBES = 1 << 18, MOST_ALONG_AXIS = 128 };

static bool is_within(vec3s size, float spacing, double most)
{
    double product = 1.0;
    for (int a = 0; a < 3; a++) {
        // Not as integers: a small spacing has more cells than they count.
        const double cells = ceil(fmax((double)size.raw[a] / (double)spacing - 1e-3, 1.0));
        if (cells > MOST_ALONG_AXIS) return false;
        product *= cells;
    }
    return product <= most;
}

// The smallest spacing from `least` upwards that has no more probes.
static float spacing_of(vec3s size, float least, double most)
{
    const float longest = glms_vec3_max(size);
    float spacing = fmaxf(least, longest / (2.0f * MOST_ALONG_AXIS));
    while (!is_within(size, spacing, most)) spacing *= 1.02f;
    return spacing;
}

struct frame_probes probe_grid_around(struct box3 box, float spacing_m, uint64_t most)
{
    const vec3s size = box3_size(box);
    if (box3_is_empty(box) || !(glms_vec3_max(size) > 0.0f)) return probe_grid_of_one();
    return probe_grid_over(box, spacing_m > 0.0f
                                    ? spacing_of(size, spacing_m, MOST_PROBES)
                                    : spacing_of(size, 0.0f, fmin((double)most, MOST_PROBES)));
}

// ---- owners

static const uint32_t NONE = UINT32_MAX;

// The owner of a neighbour along an axis; NONE: there is none yet.
static uint32_t owner_beside(const struct frame_probes *grid, const uint32_t *owner, uint32_t i)
{
    const int32_t row = grid->count_x, layer = row * grid->count_y;
    const int32_t at[3] = { (int32_t)i % row, (int32_t)i % layer / row, (int32_t)i / layer };
    const int32_t count[3] = { row, grid->count_y, grid->count_z }, stride[3] = { 1, row, layer };
    for (int a = 0; a < 3; a++)
        for (int step = -1; step <= 1; step += 2) {
            if (at[a] + step < 0 || at[a] + step >= count[a]) continue;
            const uint32_t value = owner[(int32_t)i + step * stride[a]];
            if (value != NONE) return value;
        }
    return NONE;
}

static bool sweep(const struct frame_probes *grid, const uint32_t *owner, uint32_t *next)
{
    bool changed = false;
    for (uint32_t i = 0; i < probe_grid_count(*grid); i++) {
        next[i] = owner[i] != NONE ? owner[i] : owner_beside(grid, owner, i);
        changed |= next[i] != owner[i];
    }
    return changed;
}

uint32_t *probe_owners(struct host *host, struct frame_probes grid, const vec4s *place)
{
    const size_t count = probe_grid_count(grid);
    uint32_t *owner = host_alloc(host, count, sizeof *owner);
    uint32_t *next = host_alloc(host, count, sizeof *next);
    const bool ok = owner && next;
    for (uint32_t i = 0; ok && i < count; i++) owner[i] = place[i].w > 0.0f ? i : NONE;
    while (ok && sweep(&grid, owner, next)) memcpy(owner, next, count * sizeof *owner);
    for (uint32_t i = 0; ok && i < count; i++)
        if (owner[i] == NONE) owner[i] = i;
    host_free(host, next);
    if (ok) return owner;
    host_free(host, owner);
    return NULL;
}
