// The stage that chooses offsets: the importance of one is its transference, over texels drawn
// evenly (section 3.1).
#include "techniques/ort/bake/offsets.h"

#include "bake/plan.h"
#include "techniques/ort/bake/stages.h"
#include "techniques/ort/bake/transfer.h"

#include <math.h>

enum { SAMPLES = 2048 }; // texels

struct sample {
    struct ort_receiver receiver;
    struct ort_place place;
};

struct importance {
    const struct bake_task *task;
    struct ort_transfer transfer;
    struct sample *samples;
    uint32_t count;
    bool maximum;
};

// Mean over the colours.
static float transference(const struct importance *im, const struct sample *s,
                          struct ort_offset offset)
{
    const struct ort_texels *texels = &im->transfer.texels;
    const uint32_t from = ort_texel_at(&texels->scene->map, s->place, offset.x, offset.y);
    if (from == CHART_NONE) return 0.0f;
    float single[3], multiple[3], sum = 0.0f;
    ort_transfer_single(&im->transfer, &s->receiver, from, single);
    ort_transfer_multiple(&im->transfer, &s->receiver, from, multiple);
    for (int c = 0; c < 3; c++) sum += single[c] + multiple[c];
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
        out[i] = im->maximum ? most : sum / (float)im->count;
    }
    return true;
}

// Every n-th texel that is not inside geometry.
static bool make_samples(struct importance *im)
{
    struct host *host = im->task->host;
    const struct ort_map *map = &im->transfer.texels.scene->map;
    const uint32_t wanted = map->texel_count < SAMPLES ? map->texel_count : SAMPLES;
    im->samples = host_alloc(host, wanted, sizeof *im->samples);
    for (uint32_t k = 0; im->samples && k < wanted; k++) {
        const uint32_t texel = (uint32_t)((uint64_t)k * map->texel_count / wanted);
        struct sample *s = &im->samples[im->count];
        if (!s->receiver.seen && !ort_receiver_init(&s->receiver, host, im->transfer.patch_count))
            return false;
        s->place = ort_place_of(map, texel);
        if (ort_receive(&im->transfer, texel, &s->receiver)) im->count++;
    }
    return im->samples != NULL;
}

static void destroy_samples(struct importance *im)
{
    const uint32_t most = im->transfer.texels.scene->map.texel_count;
    for (uint32_t k = 0; im->samples && k < SAMPLES && k < most; k++)
        ort_receiver_finish(&im->samples[k].receiver, im->task->host);
    host_free(im->task->host, im->samples);
}

static bool choose(struct importance *im, const struct ort_scene *scene, int32_t *out)
{
    struct host *host = im->task->host;
    const struct ort_offsets_wish wish = { .width = scene->map.width,
                                           .height = scene->map.height,
                                           .count = ort_offset_count(&scene->map, &scene->options),
                                           .seed = im->task->bake_seed,
                                           .importance = importance_of,
                                           .user = im };
    struct ort_offset *offsets = host_alloc(host, wish.count, sizeof *offsets);
    const bool ok = offsets && ort_choose_offsets(host, &wish, offsets);
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
    struct importance im = { .task = task, .maximum = scene->options.importance == ORT_MAXIMUM };
    if (scene->map.texel_count == 0) return true;
    if (!ort_transfer_init(&im.transfer, task)) return false;
    const bool ok = make_samples(&im) && choose(&im, scene, task->out[0]);
    destroy_samples(&im);
    return ok;
}

bool ort_add_offsets(struct bake_plan *plan, const struct ort_scene *scene)
{
    const uint64_t count = ort_offset_count(&scene->map, &scene->options);
    const size_t floats = 9 * (size_t)ort_patch_count(scene->map.texel_count);
    const struct bake_output out[] = {
        { ORT_OFFSETS, TENSOR_I32, 2, { count, 2 }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(plan,
                         &(struct bake_stage){ .name = "offsets",
                                               .wave = 2,
                                               .task_count = 1,
                                               .run = run,
                                               .outputs = out,
                                               .output_count = 1,
                                               .rays = 0.25 * SAMPLES * 1100,
                                               .scratch_bytes = SAMPLES * floats * sizeof(float) });
}
