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
    return bake_task_count(texels, texels * paths_of_texel, PATHS_PER_TASK);
}

void lightmap_gather_row(const struct gather_scene *scene, const struct gather_points *points,
                         int samples, uint64_t seed, float *row)
{
    const vec3s light = gather_paths(scene, points, samples, seed, &row[LIGHTMAP_VARIANCE]);
    memcpy(row, light.raw, sizeof light.raw);
    row[LIGHTMAP_SHARE] = (float)points->count / GATHER_POINTS;
}
