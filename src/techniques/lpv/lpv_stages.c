// The stages of a frame: prepare, inject, propagate, apply.
#include "techniques/lpv/lpv_state.h"

enum { LOCAL = 8 }; // of all shaders, in x and y

bool lpv_prepare(struct lpv *lpv, const struct frame_view *view)
{
    const struct lpv_options *options = &lpv->options;
    const struct lpv_lights lights = {
        .faces = view->rsm_faces,
        .face_count = view->rsm_face_count,
        .rsm_size = view->rsm_size,
        .emitters = view->emitters,
        .emitter_count = options->emitters ? view->emitter_count : 0,
    };
    struct lpv_scale scale;
    lpv->lit = lpv_grid_fit(view->bounds, options->dim, options->cell_margin, &lpv->grid) &&
               lpv_scale_of(&lights, &scale);
    if (!lpv->lit) return false;
    const struct lpv_grid *grid = &lpv->grid;
    const enum lpv_scheme scheme = (enum lpv_scheme)options->neighbours;
    const struct lpv_step step =
        lpv_step_of(scheme, (enum lpv_lobe)options->lobe, (double)options->focus);
    const float mean_way = (float)lpv_mean_way(scheme); // see lpv_apply.comp
    lpv->params = (struct lpv_params){
        .origin_m = grid->origin_m,
        .cell_m = grid->cell_m,
        .cells_x = grid->cells[0],
        .cells_y = grid->cells[1],
        .cells_z = grid->cells[2],
        .dim = options->dim,
        .ahead = step.ahead,
        .beside = step.beside,
        .diagonal = step.diagonal,
        .lobe_along = (float)step.lobe.along,
        .lobe_square = (float)step.lobe.square,
        .lobe_product = (float)step.lobe.product,
        .fixed_from_flux = scale.fixed_from_flux,
        .grid_from_fixed = scale.grid_from_flux / scale.fixed_from_flux,
        .irradiance_scale =
            options->gain * mean_way / (grid->cell_m * grid->cell_m * scale.grid_from_flux),
        .offset_m = options->offset * grid->cell_m,
        .window = options->window,
        .rsm_size = view->rsm_size,
        .width = view->width,
        .height = view->height,
        .emitter_count = (uint32_t)lights.emitter_count,
    };
    return true;
}

static struct gpu_binding grid_binding(struct lpv *lpv, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "lpv_grid", &lpv->params, sizeof lpv->params);
}

// An invocation takes `run` cells along z.
static void dispatch_cells(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                           uint32_t run, const struct gpu_binding *bindings, int count)
{
    gpu_dispatch(cmd, pipeline, bindings, count, NULL, 0,
                 gpu_groups((uint32_t)lpv->grid.cells[0], LOCAL),
                 gpu_groups((uint32_t)lpv->grid.cells[1], LOCAL),
                 gpu_groups((uint32_t)lpv->grid.cells[2], run));
}

static void inject_rsm(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const uint32_t groups = gpu_groups(view->rsm_size, LOCAL * LPV_TEXELS);
    if (view->rsm_face_count == 0) return;
    gpu_dispatch(cmd, lpv->inject,
                 GPU_BIND(grid_binding(lpv, cmd), view->rsm_faces_binding,
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal },
                          { .name = "rsm_flux", .image = view->rsm_flux },
                          { .name = "lpv_sums", .buffer = lpv->sums }),
                 NULL, 0, groups, groups, (uint32_t)view->rsm_face_count);
}

static void inject_emitters(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (lpv->params.emitter_count == 0) return;
    gpu_dispatch(cmd, lpv->inject_emitters,
                 GPU_BIND(grid_binding(lpv, cmd), view->emitters_binding,
                          { .name = "lpv_sums", .buffer = lpv->sums }),
                 NULL, 0, gpu_groups(lpv->params.emitter_count, LPV_EMITTERS_LOCAL), 1, 1);
}

void lpv_record_injection(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const size_t cells =
        (size_t)lpv->grid.cells[0] * (size_t)lpv->grid.cells[1] * (size_t)lpv->grid.cells[2];
    gpu_scope_begin(cmd, lpv->names->inject);
    gpu_fill_buffer(cmd, lpv->sums, 0, cells * lpv_cell_bytes(&lpv->options), 0);
    inject_rsm(lpv, cmd, view);
    inject_emitters(lpv, cmd, view);
    gpu_scope_end(cmd);

    gpu_scope_begin(cmd, lpv->names->resolve);
    dispatch_cells(lpv, cmd, lpv->resolve, 1,
                   GPU_BIND(grid_binding(lpv, cmd), { .name = "lpv_sums", .buffer = lpv->sums },
                            { .name = "injected", .image = lpv->injected }));
    gpu_scope_end(cmd);
}

static void record_step(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before, gpu_image after)
{
    const uint32_t run = lpv->options.neighbours == LPV_TWENTY_SIX ? LPV_RUN : 1;
    dispatch_cells(lpv, cmd, lpv->propagate, run,
                   GPU_BIND(grid_binding(lpv, cmd), { .name = "injected", .image = lpv->injected },
                            { .name = "before", .image = before },
                            { .name = "after", .image = after }));
}

// Where a step writes when `left` more follow: the last to the light, the others by turns. In 16
// bits the light's own image takes its turn.
static gpu_image step_target(const struct lpv *lpv, int left)
{
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    if (left == 0 || (half && left % 2 == 0)) return lpv->light;
    return lpv->steps[half ? 0 : (left + 1) % 2];
}

void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd)
{
    gpu_image before = lpv->injected;
    gpu_scope_begin(cmd, lpv->names->propagate);
    for (int left = lpv->options.steps - 1; left >= 0; left--) {
        const gpu_image after = step_target(lpv, left);
        record_step(lpv, cmd, before, after);
        before = after;
    }
    gpu_scope_end(cmd);
}

void lpv_record_application(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, lpv->names->apply);
    gpu_dispatch(cmd, lpv->apply,
                 GPU_BIND(grid_binding(lpv, cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "light", .image = lpv->light, .sampler = lpv->linear },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                 NULL, 0, gpu_groups(view->width, LOCAL), gpu_groups(view->height, LOCAL), 1);
    gpu_scope_end(cmd);
}

void lpv_record_debug(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out)
{
    // A flux Φ spread over all directions is the intensity Φ/4π, and radiance as in lpv_apply.comp.
    const struct lpv_view_push push = {
        .view = what,
        .radiance_scale = lpv->params.irradiance_scale / (4.0f * GLM_PIf),
    };
    const gpu_image shown = what == LPV_VIEW_PROPAGATED ? lpv->light : lpv->injected;
    gpu_scope_begin(cmd, lpv->names->debug);
    gpu_dispatch(
        cmd, lpv->debug,
        GPU_BIND(grid_binding(lpv, cmd), view->constants_binding,
                 { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                 { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                 { .name = "volume", .image = shown }, { .name = "picture", .image = out }),
        &push, sizeof push, gpu_groups(view->width, LOCAL), gpu_groups(view->height, LOCAL), 1);
    gpu_scope_end(cmd);
}
