// The stage that closes seams.
#include "techniques/common/light_map/tensors.h"

#include "bake/plan.h"
#include "trace/texels/close.h"

// RAYS_PER_PLACE: rays that take as long as a place, measured.
enum { PLACES_PER_TASK = 512, RAYS_PER_PLACE = 50 };

static bool run_seams(const struct bake_task *task)
{
    const struct seam_closing *closing = task->argument;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    struct seam_closing_scratch *scratch = seam_closing_scratch_create(task->host, closing);
    bool ok = scratch != NULL;
    for (uint64_t i = 0; ok && i < count && first + i < closing->seams.count; i++) {
        struct chart_share row[CHART_SEAM_ENTRIES];
        ok = !bake_task_cancelled(task);
        seam_close(closing, scratch, (uint32_t)(first + i), row);
        uint32_t *texel = bake_row(task, 0, i);
        float *weight = bake_row(task, 1, i);
        for (uint32_t k = 0; k < CHART_SEAM_ENTRIES; k++) {
            texel[k] = row[k].texel;
            weight[k] = row[k].weight;
        }
    }
    seam_closing_scratch_destroy(scratch);
    return ok;
}

bool light_map_add_seams(struct bake_plan *plan, const struct seam_closing *closing,
                         const struct charts *charts)
{
    struct chart_seams seams;
    if (!charts_seams_init(&seams, charts, CHART_SEAM_POINTS)) return false;
    const uint32_t places = seams.count;
    charts_seams_finish(&seams);
    const uint64_t rows = light_map_rows(places), entries = CHART_SEAM_ENTRIES;
    const struct bake_output out[] = {
        { LIGHT_MAP_SEAM_TEXEL, TENSOR_U32, 2, { rows, entries }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SEAM_WEIGHT, TENSOR_F32, 2, { rows, entries }, BAKE_ROWS, BAKE_SAVED },
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
