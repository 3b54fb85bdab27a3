// Deferred delete: an object is freed once the GPU has completed every recording that may use it.
#include "gpu/vk.h"

void deferred_delete_add(struct gpu *gpu, void (*free)(struct gpu *gpu, void *object), void *object)
{
    if (!object) return;
    if (gpu->deferred_count == gpu->deferred_capacity) {
        size_t capacity = gpu->deferred_capacity ? 2 * gpu->deferred_capacity : 64;
        struct deferred_delete *bigger =
            host_realloc(gpu->host, gpu->deferred, capacity, sizeof *bigger);
        if (!bigger) {
            // No memory for the queue: wait and free now; leak if a recording still uses it.
            timeline_wait_all(gpu);
            deferred_delete_collect(gpu);
            if (timeline_completed_serial(gpu) >= gpu->serial) free(gpu, object);
            return;
        }
        gpu->deferred = bigger;
        gpu->deferred_capacity = capacity;
    }
    gpu->deferred[gpu->deferred_count++] = (struct deferred_delete){ gpu->serial, free, object };
}

void deferred_delete_collect(struct gpu *gpu)
{
    uint64_t completed = timeline_completed_serial(gpu);
    size_t kept = 0;
    for (size_t i = 0; i < gpu->deferred_count; i++) {
        const struct deferred_delete *entry = &gpu->deferred[i];
        if (entry->serial <= completed) {
            entry->free(gpu, entry->object);
        } else {
            gpu->deferred[kept++] = *entry;
        }
    }
    gpu->deferred_count = kept;
}

void deferred_delete_finish(struct gpu *gpu)
{
    for (size_t i = 0; i < gpu->deferred_count; i++)
        gpu->deferred[i].free(gpu, gpu->deferred[i].object);
    host_free(gpu->host, gpu->deferred);
    gpu->deferred = NULL;
    gpu->deferred_count = gpu->deferred_capacity = 0;
}
