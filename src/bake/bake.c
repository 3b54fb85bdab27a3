// A bake: creation, and facts about it.
#include "bake/bake_state.h"

static bool copy_identity(struct bake *bake, const struct bake_identity *identity)
{
    struct arena *arena = &bake->plan.arena;
    bake->identity = *identity;
    bake->identity.technique = arena_strdup(arena, identity->technique);
    bake->identity.options = arena_strdup(arena, identity->options);
    bake->identity.program = arena_strdup(arena, identity->program);
    if (identity->gi) bake->identity.gi = arena_strdup(arena, identity->gi);
    if (identity->scene_name) bake->identity.scene_name = arena_strdup(arena, identity->scene_name);
    return bake->identity.technique && bake->identity.options && bake->identity.program &&
           !bake->identity.gi == !identity->gi &&
           !bake->identity.scene_name == !identity->scene_name;
}

struct bake *bake_create(struct host *host, const struct bake_identity *identity)
{
    struct bake *bake = host_alloc(host, 1, sizeof *bake);
    if (!bake) return NULL;
    bake->host = bake->plan.host = host;
    arena_init(&bake->plan.arena, host);
    pthread_mutex_init(&bake->mutex, NULL);
    pthread_mutex_init(&bake->memory, NULL);
    if (copy_identity(bake, identity)) return bake;
    bake_destroy(bake);
    return NULL;
}

void bake_destroy(struct bake *bake)
{
    if (!bake) return;
    const struct bake_job *job = &bake->plan.job;
    if (job->destroy) job->destroy(job->job);
    results_free(bake);
    safetensors_finish(bake->host, &bake->file);
    host_free(bake->host, bake->plan.stages);
    host_free(bake->host, bake->plan.parts);
    host_free(bake->host, bake->checkpoint);
    arena_finish(&bake->plan.arena);
    pthread_mutex_destroy(&bake->mutex);
    pthread_mutex_destroy(&bake->memory);
    host_free(bake->host, bake);
}

struct bake_plan *bake_plan_of(struct bake *bake)
{
    return &bake->plan;
}

bool bake_is_complete(const struct bake *bake)
{
    return bake->file.memory || bake->tensors;
}

const struct tensors *bake_tensors(const struct bake *bake)
{
    if (bake->file.memory) return &bake->file.set;
    return bake->tensors ? &bake->saved : NULL;
}

const struct tensors *bake_reported(const struct bake *bake)
{
    if (bake->file.memory) return &bake->file.set;
    return bake->tensors ? &bake->all : NULL;
}

int bake_stage_count(const struct bake *bake)
{
    return bake->plan.stage_count;
}

struct bake_stage_info bake_stage_info(const struct bake *bake, int stage)
{
    const struct planned_stage *planned = &bake->plan.stages[stage];
    struct bake_stage_info info = { .name = planned->what.name,
                                    .seconds = planned->seconds,
                                    .tasks = planned->what.task_count,
                                    .wave = planned->what.wave,
                                    .task_seconds = planned->task_seconds,
                                    .input_bytes = planned->input_bytes };
    for (int i = 0; i < planned->what.output_count; i++) {
        const struct planned_output *output = &planned->outputs[i];
        const bool sum = output->what.reduction == BAKE_SUM;
        info.result_bytes += (uint64_t)output->bytes * (sum ? info.tasks : 1);
    }
    return info;
}

double bake_seconds(const struct bake *bake)
{
    return bake->seconds;
}

double bake_prepare_seconds(const struct bake *bake)
{
    return bake->prepare_seconds;
}

uint64_t bake_bytes(const struct bake *bake)
{
    const struct tensors *tensors = bake_tensors(bake);
    uint64_t bytes = 0;
    for (size_t i = 0; tensors && i < tensors->count; i++) bytes += tensors->at[i].bytes;
    return bytes;
}

const char *bake_options_text(const struct bake *bake)
{
    return bake->identity.options;
}
