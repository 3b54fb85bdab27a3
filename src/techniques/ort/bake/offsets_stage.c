// The stage that chooses offsets: the importance of one is its transference, over texels drawn
// evenly (section 3.1).
#include "techniques/ort/bake/offsets.h"

#include "bake/plan.h"
#include "techniques/ort/bake/stages.h"
#include "techniques/ort/bake/transfer.h"

#include <math.h>

enum { SAMPLES = 2048 }; // texels

// A thousand where a group has many charts, as in the paper. The offsets of one chart need fewer:
// with 400 the error of a box is the same within its noise, and the stage takes half the time.
static uint32_t refinements_of(const struct ort_map *map, uint32_t group)
{
    const bool is_rest = group + 1 == map->group_count && map->charts.count > map->group_count;
    return map->group_count == 1 || is_rest ? 1000 : 400;
}

struct sample {
    struct ort_receiver receiver;
    struct ort_place place;
};

struct importance {
    const struct bake_task *task;
    struct ort_transfer transfer;
    struct sample *samples;
    uint32_t sample_count;
    uint32_t count; // of those that are not inside geometry
    uint32_t group;
    bool maximum;
};

// Mean over the colours.
static float transference(const struct importance *im, const struct sample *s,
                          struct ort_offset offset)
{
    const struct ort_texels *texels = &im->transfer.texels;
    const uint32_t from = ort_texel_at(&texels->scene->map, s->place, offset.x, offset.y);
    if (from == CHART_NONE) return 0.0f;
    float single[3] = { 0 }, multiple[3] = { 0 }, scattered[3] = { 0 }, sum = 0.0f;
    if (texels->scene->options.transfer != ORT_SCATTERING) {
        ort_transfer_single(&im->transfer, &s->receiver, from, single);
        ort_transfer_multiple(&im->transfer, &s->receiver, from, multiple);
    }
    if (texels->scene->kernel) ort_transfer_scattered(&im->transfer, &s->receiver, from, scattered);
    for (int c = 0; c < 3; c++) sum += single[c] + multiple[c] + scattered[c];
    return sum / 3.0f * ort_texel_area(texels, from);
}

static bool importance_of(void *user, const struct ort_offset *offsets, uint32_t count, float *out)
{
    const struct importance *im = user;
    for (uint32_t i = 0; i < count; i++) {
        float sum = 0.0f, most = 0.0f;
        if (bake_task_cancelled(im->task)) return false;
        for (uint32_t k = 0; k < im->count; k++) {
            const float t = transference(im, &im->samples[k], offsets[i]);
            sum += t;
            most = fmaxf(most, t);
        }
        out[i] = im->maximum || im->count == 0 ? most : sum / (float)im->count;
    }
    return true;
}

// Every n-th texel of the group that is not inside geometry.
static bool make_samples(struct importance *im)
{
    struct host *host = im->task->host;
    const struct ort_map *map = &im->transfer.texels.scene->map;
    const uint32_t first = map->first[im->group], texels = map->first[im->group + 1] - first;
    const uint32_t most = SAMPLES / map->group_count, wanted = texels < most ? texels : most;
    im->sample_count = wanted;
    im->samples = host_alloc(host, wanted, sizeof *im->samples);
    for (uint32_t k = 0; im->samples && k < wanted; k++) {
        const uint32_t texel = map->members[first + (uint64_t)k * texels / wanted];
        struct sample *s = &im->samples[im->count];
        if (!s->receiver.indirect &&
            !ort_receiver_init(&s->receiver, host, im->transfer.patch_count))
            return false;
        s->place = ort_place_of(map, texel);
        if (ort_receive(&im->transfer, texel, &s->receiver)) im->count++;
    }
    return im->samples != NULL;
}

static void destroy_samples(struct importance *im)
{
    for (uint32_t k = 0; im->samples && k < im->sample_count; k++)
        ort_receiver_finish(&im->samples[k].receiver, im->task->host);
    host_free(im->task->host, im->samples);
}

// Light that scatters leaves where it entered, more than anywhere else: the nearest offset gives
// way to 0, which is between its neighbours in any order.
static void include_zero(struct ort_offset *offsets, uint32_t count)
{
    uint32_t nearest = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct ort_offset a = offsets[i], b = offsets[nearest];
        if ((int64_t)a.x * a.x + (int64_t)a.y * a.y < (int64_t)b.x * b.x + (int64_t)b.y * b.y)
            nearest = i;
    }
    offsets[nearest] = (struct ort_offset){ 0, 0 };
}

static bool choose(struct importance *im, const struct ort_scene *scene, int32_t *out)
{
    struct host *host = im->task->host;
    const struct ort_offsets_wish wish = { .width = scene->map.width,
                                           .height = scene->map.height,
                                           .count = ort_offset_count(&scene->map, &scene->options),
                                           .refinements = refinements_of(&scene->map, im->group),
                                           .seed = im->task->bake_seed + im->group,
                                           .importance = importance_of,
                                           .user = im };
    struct ort_offset *offsets = host_alloc(host, wish.count, sizeof *offsets);
    const bool ok = offsets && ort_choose_offsets(host, &wish, offsets);
    if (ok && scene->kernel) include_zero(offsets, wish.count);
    for (uint32_t i = 0; ok && i < wish.count; i++) {
        out[2 * i] = offsets[i].x;
        out[2 * i + 1] = offsets[i].y;
    }
    host_free(host, offsets);
    return ok;
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct importance im = { .task = task,
                             .group = (uint32_t)task->index,
                             .maximum = scene->options.importance == ORT_MAXIMUM };
    if (scene->map.texel_count == 0) return true;
    if (!ort_transfer_init(&im.transfer, task)) return false;
    const bool ok = make_samples(&im) && choose(&im, scene, task->out[0]);
    destroy_samples(&im);
    return ok;
}

bool ort_add_offsets(struct bake_plan *plan, const struct ort_scene *scene)
{
    const uint64_t count = ort_offset_count(&scene->map, &scene->options);
    const uint64_t groups = scene->map.group_count;
    const size_t floats = 9 * (size_t)ort_patch_count(scene->map.texel_count);
    const struct bake_output out[] = {
        { ORT_OFFSETS, TENSOR_I32, 3, { groups, count, 2 }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "offsets",
                                    .wave = 2,
                                    .task_count = groups,
                                    .run = run,
                                    .outputs = out,
                                    .output_count = 1,
                                    .rays = 0.25 * SAMPLES / (double)groups *
                                            (refinements_of(&scene->map, 0) + 100),
                                    .scratch_bytes = SAMPLES / groups * floats * sizeof(float) });
}
