// Stages of the bake: samples of every shape by rays, then their volumes.
#include "techniques/dnrt/dnrt_bake.h"

#include "techniques/dnrt/bake/job.h"
#include "techniques/dnrt/bake/volume.h"
#include "techniques/dnrt/dnrt_tensors.h"
#include "trace/texels/inside.h"

#include <string.h>

enum { SAMPLES_PER_TASK = 1024 };
static const double MOST_BYTES = 2147483648.0; // of all volumes

static bool is_run(const struct dnrt_job *job, int volume)
{
    const int part = job->baked[volume].part;
    return part > 0 && !bake_plan_part_is_loaded(job->plan, part);
}

// Whether the points of a shape are those of this volume.
static bool has_patches(const struct dnrt_job *job, int volume)
{
    const struct dnrt_shape *shape =
        &job->objects.shapes[dnrt_shape_of_volume(&job->objects, volume)];
    bool any = false;
    for (int v = volume; v < shape->volume + shape->keys; v++) any = any || is_run(job, v);
    return any && job->options.self && shape->volume == volume;
}

static bool prepare_volume(struct dnrt_job *job, const struct dnrt_key_poses *keys, int v)
{
    struct dnrt_shape_trace *of = &job->volumes[v];
    const bool run = is_run(job, v), patches = has_patches(job, v);
    if (!run && !patches) return true;
    if (!dnrt_part_of_volume(&of->part, job->host, &job->objects, keys, v)) return false;
    if (run && !(of->trace = trace_scene_create(job->host, &of->part.pose))) return false;
    return !patches || dnrt_patches_init(&of->patches, job->host, &of->part);
}

static bool prepare_volumes(struct dnrt_job *job, const struct dnrt_key_poses *keys)
{
    for (int v = 0; v < job->objects.volume_count; v++)
        if (!prepare_volume(job, keys, v)) return false;
    return true;
}

static bool prepare(void *argument, struct host *host)
{
    struct dnrt_job *job = argument;
    struct dnrt_key_poses keys = { .host = NULL };
    job->host = host;
    if (!dnrt_objects_init(&job->objects, host, job->pose, job->options.keys, job->all))
        return false;
    job->volumes = host_alloc(host, (size_t)job->objects.volume_count, sizeof *job->volumes);
    const bool ok = job->volumes &&
                    dnrt_key_poses_init(&keys, host, job->pose, job->options.keys) &&
                    prepare_volumes(job, &keys);
    dnrt_key_poses_finish(&keys);
    return ok;
}

static void finish(void *argument)
{
    struct dnrt_job *job = argument;
    for (int v = 0; job->volumes && v < job->objects.volume_count; v++) {
        trace_scene_destroy(job->volumes[v].trace);
        dnrt_patches_finish(&job->volumes[v].patches);
        dnrt_part_finish(&job->volumes[v].part);
    }
    if (job->host) host_free(job->host, job->volumes);
    job->volumes = NULL;
    dnrt_objects_finish(&job->objects);
}

// ---- samples

enum { OUT_TRANSFER, OUT_INSIDE };

static struct dnrt_grid grid_of(const struct dnrt_job *job, const struct dnrt_part *part)
{
    return (struct dnrt_grid){ part->centre, part->radius * job->options.reach,
                               dnrt_size(&job->options), job->options.grid == DNRT_GRID_QUADRATIC };
}

// The factor of k_j. c_j are coefficients of irradiance; the radiance behind the object is c_j over
// the band's factor of the clamped cosine (appendix B.2, Ramamoorthi & Hanrahan 2001), where the
// paper has c_j / π.
static float hidden_factor(const struct dnrt_options *options, int coefficient)
{
    const int band = coefficient == 0 ? 0 : coefficient < SH_COUNT(2) ? 1 : 2;
    const float radiance[] = { 1.0f, 1.5f, 4.0f }; // π over π, 2π/3, π/4
    return options->occluded == DNRT_OCCLUDED_RADIANCE ? radiance[band] : 1.0f;
}

// m = t − k of each normal, and k for light that is reflected alone.
static void write_transfer(const struct dnrt_options *options, const struct dnrt_transfer *transfer,
                           float *to)
{
    for (int i = 0; i < dnrt_normals(options); i++)
        for (int j = 0; j < dnrt_coefficients(options); j++, to += dnrt_planes(options)) {
            const float hidden = transfer->of[i].hidden[j] * hidden_factor(options, j);
            for (int c = 0; c < 3; c++) to[c] = transfer->of[i].reflected[j].raw[c] - hidden;
            if (options->direct) to[3] = hidden;
        }
}

static size_t planes_of(const struct dnrt_options *options)
{
    return (size_t)(dnrt_planes(options) * dnrt_normals(options) * dnrt_coefficients(options));
}

static bool run_samples(const struct bake_task *task)
{
    const struct dnrt_job *job = task->job;
    const int volume = *(const int *)task->argument;
    const struct dnrt_shape_trace *shape = &job->volumes[volume];
    const struct dnrt_grid grid = grid_of(job, &shape->part);
    const struct dnrt_sampling how = dnrt_sampling_of(job, volume);
    uint64_t samples, first = bake_task_rows(task, OUT_TRANSFER, &samples);
    if (!(shape->part.radius > 0.0f)) return true;
    for (uint64_t i = 0; i < samples; i++) {
        if (bake_task_cancelled(task)) return false;
        struct dnrt_transfer at;
        dnrt_transfer_at(&how, dnrt_grid_point(&grid, (int)(first + i)),
                         dnrt_seed_of(task, first + i), &at);
        write_transfer(&job->options, &at, bake_row(task, OUT_TRANSFER, i));
        *(uint8_t *)bake_row(task, OUT_INSIDE, i) = is_inside(at.backs, how.rays);
    }
    return true;
}

// ---- volumes

enum { OUT_VOLUME, OUT_SCALE, OUT_SPHERE, OUT_BOX };

struct stage_argument {
    int volume;
    const char *transfer, *inside; // tensors of the samples
};

static void encode(const struct dnrt_job *job, const float *values, void *const *out)
{
    const int planes = (int)planes_of(&job->options);
    const int samples = dnrt_grid_count(dnrt_size(&job->options));
    float *scale = out[OUT_SCALE];
    for (int p = 0; p < planes; p++) {
        const size_t at = (size_t)p * (size_t)samples;
        if (job->options.bits == DNRT_BITS_16)
            scale[p] =
                dnrt_encode_half(values + p, samples, planes, (uint16_t *)out[OUT_VOLUME] + at);
        else
            scale[p] =
                dnrt_encode_byte(values + p, samples, planes, (uint8_t *)out[OUT_VOLUME] + at);
    }
}

static void write_bounds(const struct dnrt_part *part, void *const *out)
{
    const vec3s box[2] = { box3_centre(part->box),
                           glms_vec3_scale(glms_vec3_sub(part->box.max, part->box.min), 0.5f) };
    const vec4s sphere = vec4_of(part->centre, part->radius);
    memcpy(out[OUT_SPHERE], &sphere, sizeof sphere);
    if (part->radius > 0.0f) memcpy(out[OUT_BOX], box, sizeof box);
}

static bool run_volume(const struct bake_task *task)
{
    const struct dnrt_job *job = task->job;
    const struct stage_argument *of = task->argument;
    const struct dnrt_part *part = &job->volumes[of->volume].part;
    const struct tensor *transfer = bake_task_input(task, of->transfer);
    const struct tensor *inside = bake_task_input(task, of->inside);
    if (!transfer || !inside) return false;
    float *values = host_alloc(task->host, transfer->bytes, 1);
    if (!values) return false;
    memcpy(values, transfer->data, transfer->bytes);
    const bool ok = dnrt_fill_inside(task->host, dnrt_size(&job->options),
                                     (int)planes_of(&job->options), inside->data, values);
    if (ok) encode(job, values, task->out);
    write_bounds(part, task->out);
    host_free(task->host, values);
    return ok;
}

// ---- the plan

static bool add_samples(struct bake_plan *plan, const struct dnrt_job *job,
                        const struct stage_argument *of)
{
    const uint64_t samples = (uint64_t)dnrt_grid_count(dnrt_size(&job->options));
    const size_t tasks = (size_t)(samples / SAMPLES_PER_TASK);
    const struct bake_output out[] = {
        { of->transfer, TENSOR_F32, 2, { samples, planes_of(&job->options) }, BAKE_ROWS, 1 },
        { of->inside, TENSOR_U8, 1, { samples }, BAKE_ROWS, 1 },
    };
    const struct dnrt_baked *baked = &job->baked[of->volume];
    const char *name = dnrt_stage_name(plan, baked, "samples");
    return name && bake_plan_add(plan, &(struct bake_stage){ .name = name,
                                                             .wave = 0,
                                                             .part = baked->part,
                                                             .task_count = tasks,
                                                             .run = run_samples,
                                                             .argument = &of->volume,
                                                             .outputs = out,
                                                             .output_count = 2,
                                                             .rays = (double)SAMPLES_PER_TASK *
                                                                     job->options.rays });
}

static bool add_volume(struct bake_plan *plan, const struct dnrt_job *job,
                       const struct stage_argument *of)
{
    const uint64_t n = (uint64_t)dnrt_size(&job->options);
    const uint64_t count = (uint64_t)dnrt_coefficients(&job->options);
    const uint64_t normals = (uint64_t)dnrt_normals(&job->options);
    const uint64_t planes = (uint64_t)dnrt_planes(&job->options);
    const struct dnrt_baked *baked = &job->baked[of->volume];
    const struct bake_output out[] = {
        { bake_plan_name(plan, DNRT_VOLUME, baked->key),
          job->options.bits == DNRT_BITS_16 ? TENSOR_F16 : TENSOR_U8,
          6,
          { normals, count, planes, n, n, n },
          BAKE_ROWS,
          BAKE_SAVED },
        { bake_plan_name(plan, DNRT_SCALE, baked->key),
          TENSOR_F32,
          3,
          { normals, count, planes },
          BAKE_ROWS,
          BAKE_SAVED },
        { bake_plan_name(plan, DNRT_SPHERE, baked->key),
          TENSOR_F32,
          1,
          { 4 },
          BAKE_ROWS,
          BAKE_SAVED },
        { bake_plan_name(plan, DNRT_BOX, baked->key),
          TENSOR_F32,
          2,
          { 2, 3 },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    const char *name = dnrt_stage_name(plan, baked, "volume");
    return name && out[0].name && out[1].name && out[2].name && out[3].name &&
           bake_plan_add(plan, &(struct bake_stage){
                                   .name = name,
                                   .wave = 1,
                                   .part = baked->part,
                                   .task_count = 1,
                                   .run = run_volume,
                                   .argument = of,
                                   .outputs = out,
                                   .output_count = 4,
                                   .flops = (double)(n * n * n * normals * count * planes * 2),
                                   .scratch_bytes =
                                       (size_t)(n * n * n * (normals * count * planes * 4 + 4)) });
}

static struct stage_argument *arguments_of(struct bake_plan *plan, const struct dnrt_job *job,
                                           int volume)
{
    const char *key = job->baked[volume].key;
    struct stage_argument *of = bake_plan_alloc(plan, 1, sizeof *of);
    if (!of) return NULL;
    of->volume = volume;
    of->transfer = bake_plan_name(plan, "shape/%s/transfer", key);
    of->inside = bake_plan_name(plan, "shape/%s/inside", key);
    return of->transfer && of->inside ? of : NULL;
}

static bool add_stages(struct bake_plan *plan, const struct dnrt_job *job, int volumes)
{
    for (int wave = 0; wave < 2; wave++)
        for (int v = 0; v < volumes; v++) {
            if (job->baked[v].part == 0) continue;
            const struct stage_argument *of = arguments_of(plan, job, v);
            if (!of || !(wave == 0 ? add_samples : add_volume)(plan, job, of)) return false;
        }
    return true;
}

// A part for each volume of its own. The bake depends on all of them: with one, on that alone, so
// that the file of a bake of one mesh is that of its part.
static bool add_parts(struct bake_plan *plan, struct dnrt_job *job,
                      const struct dnrt_objects *objects)
{
    struct hash128 all = hash128_add_text((struct hash128){ 0 }, "dnrt");
    struct host *host = bake_plan_host(plan);
    const int count = objects->volume_count;
    struct hash128 *keys = dnrt_volume_keys(host, objects, job->pose, job->options.keys);
    struct dnrt_baked *baked = bake_plan_alloc(plan, (size_t)count, sizeof *baked);
    bool ok = keys && baked;
    for (int v = 0; ok && v < count; v++) {
        bool exists;
        hash128_print(keys[v], baked[v].key);
        const int part = bake_plan_part(plan, keys[v], &exists);
        ok = part > 0;
        if (!exists) baked[v].part = part;
        if (!exists) all = part == 1 ? keys[v] : hash128_add(all, &keys[v], sizeof *keys);
    }
    job->baked = baked;
    bake_plan_depends(plan, all);
    host_free(host, keys);
    return ok;
}

// All volumes are in one buffer of the GPU.
static bool fits(struct bake_plan *plan, const struct dnrt_job *job, int volumes)
{
    const double bytes = (double)planes_of(&job->options) *
                         dnrt_grid_count(dnrt_size(&job->options)) *
                         (job->options.bits == DNRT_BITS_16 ? 2 : 1) * volumes;
    if (bytes <= MOST_BYTES) return true;
    return host_fail(bake_plan_host(plan), FAIL_UNSUPPORTED,
                     "dnrt: %d volumes would have %.0f MB, above %.0f MB: give dnrt:size=16, "
                     "dnrt:bits=8, or fewer dnrt:keys or dnrt:normals",
                     volumes, bytes * 1e-6, MOST_BYTES * 1e-6);
}

bool dnrt_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    struct dnrt_job *job = bake_plan_alloc(plan, 1, sizeof *job);
    struct host *host = bake_plan_host(plan);
    struct dnrt_objects objects;
    struct dnrt_key_poses keys = { .host = NULL };
    if (!job) return false;
    job->pose = how->pose;
    job->options = *(const struct dnrt_options *)how->options;
    job->plan = plan;
    job->all = how->all_objects;
    bake_plan_set_job(plan, &(struct bake_job){ .job = job, .prepare = prepare, .finish = finish });
    const bool ok = dnrt_objects_init(&objects, host, how->pose, job->options.keys, job->all) &&
                    fits(plan, job, objects.volume_count) && add_parts(plan, job, &objects) &&
                    dnrt_key_poses_init(&keys, host, how->pose, job->options.keys) &&
                    dnrt_add_self_stages(plan, job, &objects, &keys) &&
                    add_stages(plan, job, objects.volume_count);
    dnrt_key_poses_finish(&keys);
    dnrt_objects_finish(&objects);
    return ok;
}
