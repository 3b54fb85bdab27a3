// Pipelines compiled by another thread: a device for them alone, with tables of its own, whose
// pipelines the real device keeps until an equal one is created.
#include "gpu/vk.h"

struct gpu *gpu_compiler_create(const struct gpu *gpu, struct host *host)
{
    struct gpu *c = host_alloc(host, 1, sizeof *c);
    if (!c) return NULL;
    c->compiler = true;
    c->host = host;
    c->info = gpu->info;
    c->limits = gpu->limits;
    c->vk_limits = gpu->vk_limits;
    c->max_push_descriptors = gpu->max_push_descriptors;
    c->shader_dir = gpu->shader_dir; // not owned
    c->physical = gpu->physical;
    c->device = gpu->device;
    c->allocator = gpu->allocator;
    c->vk = gpu->vk;
    c->pipeline_cache = gpu->pipeline_cache; // synchronized by Vulkan
    return c;
}

void gpu_compiler_set_host(struct gpu *compiler, struct host *host)
{
    compiler->host = host;
}

uint32_t gpu_compiler_count(const struct gpu *compiler)
{
    return compiler->pipelines.live;
}

static bool keep(struct gpu *gpu, struct pipeline *p)
{
    struct compiled_pipelines *list = &gpu->compiled;
    if (list->count == COMPILED_PIPELINES) // no recording has used it
        pipeline_free(gpu, compiled_remove(list, 0));
    struct pipeline **bigger =
        host_realloc(gpu->host, list->at, (size_t)list->count + 1, sizeof *list->at);
    if (!bigger) return false;
    list->at = bigger;
    list->at[list->count++] = p;
    return true;
}

// Files may change until the pipeline is used.
static bool is_of_files(const struct pipeline *p)
{
    for (int i = 0; i < p->stage_count; i++)
        if (p->stages[i].stamp) return true;
    return false;
}

void gpu_compiler_destroy(struct gpu *c, struct gpu *gpu)
{
    if (!c) return;
    for (uint32_t i = 0; i < c->pipelines.count; i++) {
        struct pipeline *p = c->pipelines.objects[i];
        if (!p || --p->users > 0) continue;                   // a later handle of it
        pipeline_free(gpu, compiled_take(&gpu->compiled, p)); // an equal one of before
        if (is_of_files(p) || !keep(gpu, p)) pipeline_free(gpu, p);
    }
    table_finish(gpu->host, &c->pipelines);
    host_free(gpu->host, c);
}

void compiled_finish(struct gpu *gpu)
{
    while (gpu->compiled.count > 0) pipeline_free(gpu, compiled_remove(&gpu->compiled, 0));
    host_free(gpu->host, gpu->compiled.at);
    gpu->compiled.at = NULL;
}
