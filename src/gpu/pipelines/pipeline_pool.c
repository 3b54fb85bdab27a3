// Pipelines that were destroyed, kept for the next creation of an equal one. Compiling takes
// drivers up to a second per technique; an option that recreates its technique need not wait for
// it.
#include "gpu/vk.h"

#include <string.h>

static bool same_stage(const struct shader_stage *a, const struct shader_stage *b)
{
    return a->stage == b->stage && a->embedded.words == b->embedded.words && !a->stamp && !b->stamp;
}

static bool same_fixed_state(const struct gpu_graphics_desc *a, const struct gpu_graphics_desc *b)
{
    return memcmp(a->color_formats, b->color_formats, sizeof a->color_formats) == 0 &&
           a->depth_format == b->depth_format && a->depth_compare == b->depth_compare &&
           a->depth_write == b->depth_write && a->depth_clamp == b->depth_clamp &&
           memcmp(&a->depth_bias_slope, &b->depth_bias_slope, sizeof a->depth_bias_slope) == 0 &&
           a->blend == b->blend;
}

static bool same_constants(const struct pipeline *a, const struct pipeline *b)
{
    return a->constant_count == b->constant_count &&
           (!a->constant_count || memcmp(a->constants, b->constants,
                                         (size_t)a->constant_count * sizeof *a->constants) == 0);
}

bool pipeline_is_equal(const struct pipeline *a, const struct pipeline *b)
{
    bool same = a->graphics == b->graphics && a->stage_count == b->stage_count &&
                strcmp(a->name, b->name) == 0 && same_constants(a, b) &&
                same_fixed_state(&a->desc, &b->desc);
    for (int i = 0; same && i < a->stage_count; i++)
        same = same_stage(&a->stages[i], &b->stages[i]);
    return same;
}

struct pipeline *pipeline_find_equal(const struct table *pipelines, const struct pipeline *like)
{
    for (uint32_t i = 0; i < pipelines->count; i++)
        if (pipelines->objects[i] && pipeline_is_equal(pipelines->objects[i], like))
            return pipelines->objects[i];
    return NULL;
}

static struct pipeline *remove_at(struct pipeline_pool *pool, int index)
{
    struct pipeline *p = pool->pipelines[index];
    pool->count--;
    memmove(&pool->pipelines[index], &pool->pipelines[index + 1],
            (size_t)(pool->count - index) * sizeof p);
    return p;
}

struct pipeline *pipeline_pool_take(struct pipeline_pool *pool, const struct pipeline *like)
{
    for (int i = pool->count; i-- > 0;)
        if (pipeline_is_equal(pool->pipelines[i], like)) return remove_at(pool, i);
    return NULL;
}

struct pipeline *pipeline_pool_give(struct pipeline_pool *pool, struct pipeline *p)
{
    for (int i = 0; i < p->stage_count; i++)
        if (p->stages[i].stamp) return p; // the file may change
    struct pipeline *oldest =
        pool->count == POOLED_PIPELINES ? pipeline_pool_remove_oldest(pool) : NULL;
    pool->pipelines[pool->count++] = p;
    return oldest;
}

struct pipeline *pipeline_pool_remove_oldest(struct pipeline_pool *pool)
{
    return pool->count ? remove_at(pool, 0) : NULL;
}

struct pipeline *compiled_remove(struct compiled_pipelines *list, int index)
{
    struct pipeline *p = list->at[index];
    list->count--;
    memmove(list->at + index, list->at + index + 1,
            (size_t)(list->count - index) * sizeof *list->at);
    return p;
}

struct pipeline *compiled_take(struct compiled_pipelines *list, const struct pipeline *like)
{
    for (int i = list->count; i-- > 0;)
        if (pipeline_is_equal(list->at[i], like)) return compiled_remove(list, i);
    return NULL;
}
