// The objects of a technique's table around its functions.
#include "techniques/technique.h"

#include <string.h>

static void list(const struct technique *technique, const void *options, int view, uint32_t width,
                 uint32_t height, struct gpu_objects *out)
{
    gpu_objects_clear(out);
    if (technique->objects) technique->objects(options, view, width, height, out);
}

// Leaves those of the view. shared: without images that alias those of other views.
static void keep_view(struct gpu_objects *table, bool shared)
{
    int kept = 0;
    for (int i = 0; i < table->count; i++)
        if (table->at[i].of_view && !(shared && table->at[i].image.alias))
            table->at[kept++] = table->at[i];
    table->count = kept;
}

bool technique_create(const struct technique *technique, void *state,
                      const struct technique_create *how)
{
    struct gpu_objects table;
    if (technique->options.size > 0) memcpy(state, how->options, technique->options.size);
    list(technique, how->options, 0, how->width, how->height, &table);
    return gpu_objects_create(how->gpu, &table, 0, state) &&
           (!technique->create || technique->create(state, how));
}

bool technique_compile(const struct technique *technique, const void *options, struct gpu *compiler)
{
    struct gpu_objects table;
    list(technique, options, 0, 1, 1, &table);
    gpu_owner_push(compiler, technique->name);
    const bool ok = gpu_objects_compile(compiler, &table);
    gpu_owner_pop(compiler);
    return ok;
}

void technique_set_options(const struct technique *technique, void *state, const void *options)
{
    const int effect = option_difference(&technique->options, state, options);
    if (technique->set_options) technique->set_options(state, options);
    option_copy_live(&technique->options, options, state);
    if (technique->invalidate && (effect >= INVALIDATE || !technique->set_options))
        technique->invalidate(state, CHANGED_OPTIONS);
}

bool technique_resize(const struct technique *technique, struct gpu *gpu, void *state,
                      const void *options, int view, uint32_t width, uint32_t height)
{
    struct gpu_objects table;
    list(technique, options, view, width, height, &table);
    keep_view(&table, false);
    gpu_objects_destroy(gpu, &table, state);
    return gpu_objects_create(gpu, &table, 0, state) &&
           (!technique->resize || technique->resize(state, view, width, height));
}

void technique_destroy(const struct technique *technique, struct gpu *gpu, void *state,
                       const void *options)
{
    struct gpu_objects table;
    if (technique->destroy) technique->destroy(state);
    for (int view = 0; view < FRAME_MAX_VIEWS; view++) {
        list(technique, options, view, 0, 0, &table);
        if (view > 0) keep_view(&table, false);
        gpu_objects_destroy(gpu, &table, state);
    }
}

uint64_t technique_memory(const struct technique *technique, const void *options, uint32_t width,
                          uint32_t height)
{
    struct gpu_objects table;
    list(technique, options, 0, width, height, &table);
    return gpu_objects_bytes(&table) +
           (technique->memory_estimate ? technique->memory_estimate(options) : 0);
}

uint64_t technique_view_memory(const struct technique *technique, const void *options,
                               uint32_t width, uint32_t height, bool shared)
{
    struct gpu_objects table;
    list(technique, options, 1, width, height, &table);
    keep_view(&table, shared);
    return gpu_objects_bytes(&table);
}
