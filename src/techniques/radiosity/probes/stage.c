#include "techniques/radiosity/probes/stage.h"

#include "core/half.h"
#include "techniques/radiosity/probes/bake.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include <string.h>

enum { PROBES_PER_TASK = 32 };
enum { OUT_SOURCE, OUT_FACTOR, OUT_PLACE, OUT_SKY, OUT_EMITTED, OUT_DEPTH, OUT_COUNT };

bool radiosity_probe_plan(struct bake_plan *plan, struct frame_probes grid,
                          const struct radiosity_options *options,
                          bool (*run)(const struct bake_task *task), size_t room_bytes)
{
    const uint64_t probes = probe_grid_count(grid), most = 2 * (uint64_t)options->sources;
    const struct bake_output out[OUT_COUNT] = {
        { RADIOSITY_PROBE_SOURCE, TENSOR_U32, 2, { probes, most }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_FACTOR, TENSOR_F16, 3, { probes, most, 4 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_PLACE, TENSOR_F32, 2, { probes, 4 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_SKY, TENSOR_F32, 2, { probes, RADIOSITY_SH }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PROBE_EMITTED,
          TENSOR_F32,
          3,
          { probes, RADIOSITY_SH, 3 },
          BAKE_ROWS,
          BAKE_SAVED },
        { RADIOSITY_PROBE_DEPTH,
          TENSOR_F16,
          3,
          { probes, PROBE_DEPTHS, 2 },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    const size_t tasks = (size_t)((probes + PROBES_PER_TASK - 1) / PROBES_PER_TASK);
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "probes",
                                    .wave = 0,
                                    .task_count = tasks,
                                    .run = run,
                                    .outputs = out,
                                    .output_count = OUT_COUNT,
                                    .rays = (double)probes * 2 * options->rays / (double)tasks,
                                    .scratch_bytes = room_bytes });
}

static void write_row(const struct bake_task *task, uint64_t i, uint64_t most,
                      const struct radiosity_entry *row, uint32_t count)
{
    uint32_t *source = (uint32_t *)task->out[OUT_SOURCE] + i * most;
    uint16_t(*factor)[4] = (uint16_t(*)[4])task->out[OUT_FACTOR] + i * most;
    for (uint32_t k = 0; k < count; k++) {
        source[k] = row[k].node;
        factor[k][0] = half_from_float(row[k].factor.weight);
        for (int a = 0; a < 3; a++) factor[k][1 + a] = half_from_float(row[k].factor.along[a]);
    }
}

static void write_probe(const struct bake_task *task, uint64_t i,
                        const struct radiosity_probe *probe)
{
    float *place = (float *)task->out[OUT_PLACE] + 4 * i;
    memcpy(place, probe->position.raw, sizeof probe->position.raw);
    place[3] = probe->valid;
    memcpy((float *)task->out[OUT_SKY] + RADIOSITY_SH * i, probe->sky, sizeof probe->sky);
    memcpy((float *)task->out[OUT_EMITTED] + 3 * RADIOSITY_SH * i, probe->emitted,
           sizeof probe->emitted);
    memcpy((uint16_t *)task->out[OUT_DEPTH] + 2 * PROBE_DEPTHS * i, probe->depth,
           sizeof probe->depth);
}

bool radiosity_probe_run(const struct bake_task *task, const struct radiosity_scene *scene,
                         const struct radiosity_probe_room *room)
{
    const struct frame_probes grid = radiosity_probe_grid(&scene->map, &scene->options);
    const uint64_t most = 2 * (uint64_t)scene->options.sources;
    uint64_t count, first = bake_task_rows(task, OUT_SOURCE, &count);
    for (uint64_t i = 0; i < count; i++) {
        struct radiosity_probe probe;
        if (bake_task_cancelled(task)) return false;
        radiosity_probe_gather(scene, grid, (uint32_t)(first + i), task->bake_seed, room->gather,
                               &probe);
        const uint32_t entries = radiosity_make_row(room->rows, room->gather, (uint32_t)most,
                                                    task->bake_seed ^ (first + i) << 32, room->row);
        write_row(task, i, most, room->row, entries);
        write_probe(task, i, &probe);
    }
    return true;
}
