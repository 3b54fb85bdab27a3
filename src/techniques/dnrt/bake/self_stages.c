// Stages of the bake with the option `self`: points on the surface of every shape.
#include "techniques/dnrt/bake/job.h"

#include "core/half.h"
#include "techniques/dnrt/dnrt_tensors.h"

#include <string.h>

enum { OUT_SELF, OUT_CORNERS = 0, OUT_PATCHES };

static bool run_self(const struct bake_task *task)
{
    const struct dnrt_job *job = task->job;
    const int volume = *(const int *)task->argument;
    const struct dnrt_patches *patches =
        &job->volumes[dnrt_first_volume(&job->objects, volume)].patches;
    const struct dnrt_sampling how = dnrt_sampling_of(job, volume);
    const int count = dnrt_coefficients(&job->options);
    uint64_t points, first = bake_task_rows(task, OUT_SELF, &points);
    uint16_t *to = task->out[OUT_SELF];
    for (uint64_t i = 0; i < points; i++) {
        vec4s at[DNRT_MAX_COEFFICIENTS];
        if (bake_task_cancelled(task)) return false;
        dnrt_self_at(&how, patches, (uint32_t)(first + i), dnrt_seed_of(task, first + i), at);
        for (int j = 0; j < 4 * count; j++) *to++ = half_from_float(at[j / 4].raw[j % 4]);
    }
    return true;
}

static bool run_patches(const struct bake_task *task)
{
    const struct dnrt_job *job = task->job;
    const int volume = *(const int *)task->argument;
    const struct dnrt_patches *patches =
        &job->volumes[dnrt_first_volume(&job->objects, volume)].patches;
    vec3s *corners = task->out[OUT_CORNERS];
    memcpy(task->out[OUT_PATCHES], patches->at, patches->count * sizeof *patches->at);
    for (uint32_t i = 0; i < patches->count; i++)
        dnrt_patch_corners(&job->volumes[volume].part, i, corners + 3 * (size_t)i);
    return true;
}

static bool add_self(struct bake_plan *plan, const struct dnrt_job *job, const int *volume,
                     const struct dnrt_patches *patches)
{
    enum { POINTS_PER_TASK = 256 };
    const uint64_t coefficients = (uint64_t)dnrt_coefficients(&job->options);
    const struct dnrt_baked *of = &job->baked[*volume];
    const struct bake_output corners[] = {
        { bake_plan_name(plan, DNRT_CORNERS, of->key),
          TENSOR_F32,
          3,
          { patches->count, 3, 3 },
          BAKE_ROWS,
          BAKE_SAVED },
        { bake_plan_name(plan, DNRT_PATCHES, of->key),
          TENSOR_U32,
          2,
          { patches->count, 2 },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    const struct bake_output self[] = {
        { bake_plan_name(plan, DNRT_SELF, of->key),
          TENSOR_F16,
          3,
          { patches->points, coefficients, 4 },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    const struct bake_stage geometry = { .name = dnrt_stage_name(plan, of, "patches"),
                                         .part = of->part,
                                         .task_count = 1,
                                         .run = run_patches,
                                         .argument = volume,
                                         .outputs = corners,
                                         .output_count = 2 };
    const struct bake_stage transfer = { .name = dnrt_stage_name(plan, of, "self"),
                                         .part = of->part,
                                         .task_count = (patches->points + POINTS_PER_TASK - 1) /
                                                       POINTS_PER_TASK,
                                         .run = run_self,
                                         .argument = volume,
                                         .outputs = self,
                                         .output_count = 1,
                                         .rays = (double)POINTS_PER_TASK * job->options.rays };
    return corners[0].name && corners[1].name && self[0].name && geometry.name && transfer.name &&
           (patches->count == 0 ||
            (bake_plan_add(plan, &geometry) && bake_plan_add(plan, &transfer)));
}

bool dnrt_add_self_stages(struct bake_plan *plan, const struct dnrt_job *job,
                          const struct dnrt_objects *objects, const struct dnrt_key_poses *keys)
{
    bool ok = true;
    for (int i = 0; i < objects->shape_count && ok && job->options.self; i++) {
        const struct dnrt_shape *shape = &objects->shapes[i];
        struct dnrt_part part;
        struct dnrt_patches patches = { .host = NULL };
        ok = dnrt_part_of_volume(&part, bake_plan_host(plan), objects, keys, shape->volume) &&
             dnrt_patches_init(&patches, bake_plan_host(plan), &part);
        for (int v = shape->volume; v < shape->volume + shape->keys && ok; v++) {
            if (job->baked[v].part == 0) continue;
            int *volume = bake_plan_alloc(plan, 1, sizeof *volume);
            if (volume) *volume = v;
            ok = volume && add_self(plan, job, volume, &patches);
        }
        dnrt_patches_finish(&patches);
        dnrt_part_finish(&part);
    }
    return ok;
}
