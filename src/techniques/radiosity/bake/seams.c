// The stage that closes seams.
#include "techniques/radiosity/bake/close.h"

#include "techniques/radiosity/radiosity_tensors.h"

// A place takes as long as so many rays, measured.
enum { PLACES_PER_TASK = 512, RAYS_PER_PLACE = 50 };

static bool run_seams(const struct bake_task *task)
{
    const struct radiosity_closing *closing = task->argument;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    struct radiosity_closing_room room;
    bool ok = radiosity_closing_room_init(&room, task->host, closing);
    for (uint64_t i = 0; ok && i < count && first + i < closing->seams.count; i++) {
        struct radiosity_closing_entry row[RADIOSITY_SEAM_ENTRIES];
        ok = !bake_task_cancelled(task);
        radiosity_close(closing, &room, (uint32_t)(first + i), row);
        uint32_t *texel = bake_row(task, 0, i);
        float *weight = bake_row(task, 1, i);
        for (uint32_t k = 0; k < RADIOSITY_SEAM_ENTRIES; k++) {
            texel[k] = row[k].texel;
            weight[k] = row[k].weight;
        }
    }
    radiosity_closing_room_finish(&room);
    return ok;
}

bool radiosity_add_seams(struct bake_plan *plan, const struct radiosity_closing *closing,
                         uint32_t places)
{
    const uint64_t rows = radiosity_rows(places), entries = RADIOSITY_SEAM_ENTRIES;
    const struct bake_output out[] = {
        { RADIOSITY_SEAM_TEXEL, TENSOR_U32, 2, { rows, entries }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_SEAM_WEIGHT, TENSOR_F32, 2, { rows, entries }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(plan,
                         &(struct bake_stage){
                             .name = "seams",
                             .wave = 1,
                             .task_count = (size_t)((rows + PLACES_PER_TASK - 1) / PLACES_PER_TASK),
                             .run = run_seams,
                             .argument = closing,
                             .outputs = out,
                             .output_count = 2,
                             .others = (double)RAYS_PER_PLACE * PLACES_PER_TASK,
                             .scratch_bytes = (size_t)places * 8 });
}
