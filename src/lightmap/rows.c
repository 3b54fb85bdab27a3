#include "lightmap/rows.h"

#include "lightmap/lightmap.h"

#include <string.h>

bool lightmap_run_rows(const struct bake_task *task, uint64_t texels, lightmap_row *each,
                       void *user)
{
    uint64_t count, first = bake_task_rows(task, 0, &count);
    const unsigned before = embree_flush_denormals();
    bool ok = true;
    for (uint64_t i = 0; ok && i < count && first + i < texels; i++) {
        ok = !bake_task_cancelled(task);
        if (ok) each(user, task, (uint32_t)(first + i), i);
    }
    embree_restore_denormals(before);
    return ok;
}

// Some thousand paths, so that a task takes a fraction of a second.
enum { PATHS_PER_TASK = 16384 };

size_t lightmap_task_count(uint64_t texels, uint64_t paths_of_texel)
{
    const uint64_t tiles = (texels + GATHER_TILE - 1) / GATHER_TILE;
    return bake_task_count(tiles, texels * paths_of_texel, PATHS_PER_TASK);
}

void lightmap_write_row(const struct gather_tile *tile, uint32_t texel, float *row)
{
    const uint32_t i = texel - tile->first;
    if (tile->points[i].count == 0) return;
    memcpy(row, tile->light[i].raw, sizeof tile->light[i].raw);
    row[LIGHTMAP_VARIANCE] = tile->variance[i];
    row[LIGHTMAP_SHARE] = (float)tile->points[i].count / GATHER_POINTS;
}
