// One stage: its tasks are strips of pixels with all their samples.
#include "reference/stages.h"

#include "bake/scene_key.h"

#include <inttypes.h>

// F64 [strips][REFERENCE_STRIP_VALUES]: sums of samples, cd/m² and lux, and their squares; rays.
static const char SUMS[] = "strips/sums";
// A task takes a fraction of a second. Between looks at whether it is cancelled a strip has some
// thousand paths.
enum { PATHS_PER_TASK = 32768, SAMPLES_PER_LOOK = 256, RAYS_PER_PATH = 4 };

struct job {
    struct reference_bake how;
    struct reference *reference; // between prepare and finish
};

static struct reference *create(struct host *host, const struct reference_bake *how)
{
    return reference_create(host, how->pose, &how->camera, how->width, how->height, &how->options);
}

// Each process learns where light comes from by itself: the same everywhere.
static bool prepare(void *argument, struct host *host)
{
    struct job *job = argument;
    job->reference = create(host, &job->how);
    return job->reference && reference_train(job->reference);
}

static void finish(void *argument)
{
    struct job *job = argument;
    reference_destroy(job->reference);
    job->reference = NULL;
}

static bool run(const struct bake_task *task)
{
    const struct job *job = task->job;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    for (uint64_t i = 0; i < count; i++)
        for (int left = job->how.samples, some; left > 0; left -= some) {
            const int from = job->how.samples - left;
            if (bake_task_cancelled(task)) return false;
            some = left < SAMPLES_PER_LOOK ? left : SAMPLES_PER_LOOK;
            reference_trace_strip(job->reference, (size_t)(first + i), from, from + some,
                                  bake_row(task, 0, i));
        }
    return true;
}

static uint64_t strip_count(const struct reference_bake *how)
{
    const uint64_t wide = ((uint64_t)how->width + REFERENCE_STRIP - 1) / REFERENCE_STRIP;
    const uint64_t high = ((uint64_t)how->height + REFERENCE_STRIP - 1) / REFERENCE_STRIP;
    return wide * high * REFERENCE_STRIP;
}

static size_t scene_bytes(const struct scene_pose *pose)
{
    size_t triangles = 0;
    for (int i = 0; i < pose->scene->instance_count; i++)
        if (pose->scene->instances[i].mesh >= 0)
            triangles += scene_mesh_of(pose->scene, i)->index_count / 3;
    return triangles * TRACE_TRIANGLE_BYTES;
}

char *reference_bake_options(struct host *host, const struct reference_bake *how)
{
    const struct reference_options *o = &how->options;
    const struct world_camera *c = &how->camera;
    const float view[] = { c->eye.x,           c->eye.y, c->eye.z, c->forward.x, c->forward.y,
                           c->forward.z,       c->up.x,  c->up.y,  c->up.z,      c->near_m,
                           c->vertical_fov_rad };
    return host_sprintf(host,
                        "width=%d,height=%d,samples=%d,bounces=%d,direct_only=%d,indirect_only=%d,"
                        "guiding=%d,antialias=%d,camera=%016" PRIx64,
                        how->width, how->height, how->samples, o->bounces, o->direct_only,
                        o->indirect_only, o->guiding, o->antialias,
                        hash_bytes(view, sizeof view, 0));
}

bool reference_add_stages(struct bake_plan *plan, const struct reference_bake *how)
{
    struct job *job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) return false;
    job->how = *how;
    const uint64_t strips = strip_count(how);
    const double pixels = (double)how->width * (double)how->height;
    const uint64_t paths = (uint64_t)how->width * (uint64_t)how->height * (uint64_t)how->samples;
    const size_t tasks = bake_task_count(strips, paths, PATHS_PER_TASK);
    const struct bake_output sums = { SUMS,      TENSOR_F64, 2, { strips, REFERENCE_STRIP_VALUES },
                                      BAKE_ROWS, BAKE_SAVED };
    bake_plan_depends(plan, scene_key_lit(how->pose));
    bake_plan_set_job(plan, &(struct bake_job){ .job = job,
                                                .prepare = prepare,
                                                .finish = finish,
                                                .bytes = scene_bytes(how->pose) });
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "samples",
                                    .task_count = tasks,
                                    .run = run,
                                    .outputs = &sums,
                                    .output_count = 1,
                                    .rays = (double)paths * RAYS_PER_PATH / (double)tasks,
                                    .texels = pixels / (double)tasks });
}

struct reference *reference_of_bake(struct host *host, const struct reference_bake *how,
                                    const struct tensors *tensors)
{
    const double *sums =
        TENSORS_EXPECT(host, tensors, SUMS, TENSOR_F64, strip_count(how), REFERENCE_STRIP_VALUES);
    struct reference *reference = sums ? create(host, how) : NULL;
    if (!reference || reference_set_strips(reference, how->samples, sums)) return reference;
    reference_destroy(reference);
    return NULL;
}
