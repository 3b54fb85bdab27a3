// Tasks whose rows are texels.
#include "lightmap/stages.h"

bool lightmap_run_rows(const struct bake_task *task,
                       void (*gather)(const struct bake_task *task, uint32_t texel, uint64_t row))
{
    const struct lightmap_job *job = task->job;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    const unsigned before = embree_flush_denormals();
    bool ok = true;
    for (uint64_t i = 0; ok && i < count && first + i < job->charts.side_texel_count; i++) {
        ok = !bake_task_cancelled(task);
        if (ok) gather(task, (uint32_t)(first + i), i);
    }
    embree_restore_denormals(before);
    return ok;
}

// Some thousand paths, so that a task takes a fraction of a second.
enum { PATHS_PER_TASK = 16384 };

size_t lightmap_task_count(uint64_t texels, uint64_t paths_of_texel)
{
    const uint64_t tasks = (texels * paths_of_texel + PATHS_PER_TASK - 1) / PATHS_PER_TASK;
    return (size_t)(tasks < texels ? tasks : texels);
}
