// Cascades (Kaplanyan & Dachsbacher 2010): nested grids with cells of several sizes. Each cascade
// starts from the light of the next coarser one.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

#include <stddef.h>
#include <string.h>

void lpv_cascades_create(struct lpv_cascades *cascades)
{
    const size_t own = offsetof(struct lpv_volumes, light);
    const struct lpv *finest = &cascades->levels[0];
    for (int i = 1; i < finest->options.cascades; i++) {
        struct lpv *level = &cascades->levels[i];
        struct lpv_volumes volumes = finest->volumes;
        memcpy((char *)&volumes + own, (char *)&level->volumes + own, sizeof volumes - own);
        *level = *finest;
        level->volumes = volumes;
        level->coarser = NULL;
        cascades->levels[i - 1].coarser = level;
    }
}

// Enough steps for the light of all bounces, which crosses the coarsest grid several times, at most
// 16 times the steps of the others; its cells are few.
static int32_t steps_of_coarsest(const struct lpv *finest, const struct lpv_grid *grid)
{
    int32_t longest = 0;
    for (int axis = 0; axis < 3; axis++)
        longest = grid->cells[axis] > longest ? grid->cells[axis] : longest;
    const int32_t steps = finest->options.steps;
    const int32_t needed = finest->options.neighbours == LPV_SIX ? steps * longest : 3 * longest;
    return needed < steps ? steps : needed < 16 * steps ? needed : 16 * steps;
}

bool lpv_cascades_place(struct lpv *finest, const struct frame_view *view)
{
    const struct lpv_options *options = &finest->options;
    const float margin = lpv_margin(options, view->constants->sky);
    if (!lpv_grid_fit(view->bounds, options->dim, margin, &finest->grid)) return false;
    if (!finest->coarser) return true;
    float cell_m = options->cell > 0.0f ? options->cell : 0.5f * finest->grid.cell_m;
    for (struct lpv *level = finest; level; level = level->coarser, cell_m *= 2.0f) {
        lpv_grid_around(view->bounds, options->dim, margin, cell_m,
                        view->constants->camera_position, &level->grid);
        level->options = *options;
        if (!level->coarser) level->options.steps = steps_of_coarsest(finest, &level->grid);
    }
    return true;
}

void lpv_record_refinement(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image to)
{
    const struct lpv_grid *grid = &lpv->grid, *coarser = &lpv->coarser->grid;
    const struct lpv_refine_push push = {
        .first = glms_vec3_divs(glms_vec3_sub(grid->origin_m, coarser->origin_m), coarser->cell_m),
        .ratio = grid->cell_m / coarser->cell_m,
        .cells_x = coarser->cells[0],
        .cells_y = coarser->cells[1],
        .cells_z = coarser->cells[2],
    };
    lpv_dispatch_cells_push(
        lpv, cmd, lpv->pipelines.refine,
        GPU_BIND(
            lpv_grid_binding(lpv, cmd),
            { .name = "coarser", .image = lpv->coarser->volumes.light, .sampler = lpv->linear },
            { .name = "refined", .image = to },
            { .name = "lpv_walls", .buffer = lpv_walls(lpv->coarser) }),
        &push, sizeof push);
}
