// Cascades (Kaplanyan & Dachsbacher 2010): nested grids with cells of several sizes. Each cascade
// starts from the light of the next coarser one.
#include "techniques/lpv/lpv_prepare.h"

#include "techniques/lpv/lpv_frame.h"

// Enough steps for the light of all bounces, which crosses the coarsest grid several times, at most
// 16 times the steps of the others; its cells are few.
static int32_t steps_of_coarsest(const struct lpv_options *options, const struct lpv_grid *grid)
{
    int32_t longest = 0;
    for (int axis = 0; axis < 3; axis++)
        longest = grid->cells[axis] > longest ? grid->cells[axis] : longest;
    const int32_t steps = options->steps;
    const int32_t needed = options->neighbours == LPV_SIX ? steps * longest : 3 * longest;
    return needed < steps ? steps : needed < 16 * steps ? needed : 16 * steps;
}

bool lpv_cascades_place(const struct lpv_options *options, struct lpv_cascade *finest,
                        const struct frame_view *view)
{
    const float margin = lpv_margin(options, view->constants->sky);
    finest->steps = options->steps;
    if (!lpv_grid_fit(view->bounds, options->dim, margin, &finest->grid)) return false;
    if (!finest->coarser) return true;
    float cell_m = options->cell > 0.0f ? options->cell : 0.5f * finest->grid.cell_m;
    for (struct lpv_cascade *c = finest; c; c = c->coarser, cell_m *= 2.0f) {
        lpv_grid_around(view->bounds, options->dim, margin, cell_m,
                        view->constants->camera_position, &c->grid);
        c->steps = c->coarser ? options->steps : steps_of_coarsest(options, &c->grid);
    }
    return true;
}
