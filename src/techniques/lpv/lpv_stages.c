// The stages of a frame: prepare, inject, propagate, apply.
#include "techniques/lpv/lpv_state.h"

enum { LOCAL = 8 }; // of all shaders, in x and y

// Mean chord of a cube over its side, 4 V/S (Cauchy): see lpv_apply.comp.
static const float MEAN_CHORD = 2.0f / 3.0f;

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
    const struct lpv_step step = lpv_step_of((enum lpv_lobe)options->lobe, options->focus);
    lpv->params = (struct lpv_params){
        .origin_m = grid->origin_m,
        .cell_m = grid->cell_m,
        .cells_x = grid->cells[0],
        .cells_y = grid->cells[1],
        .cells_z = grid->cells[2],
        .dim = options->dim,
        .keep = step.keep,
        .drive = step.drive,
        .aim = step.aim,
        .along = step.along,
        .across = step.across,
        .fixed_from_flux = scale.fixed_from_flux,
        .grid_from_fixed = scale.grid_from_flux / scale.fixed_from_flux,
        .irradiance_scale =
            options->gain * MEAN_CHORD / (grid->cell_m * grid->cell_m * scale.grid_from_flux),
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

static void dispatch_cells(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                           const struct gpu_binding *bindings, int count)
{
    gpu_dispatch(cmd, pipeline, bindings, count, NULL, 0,
                 gpu_groups((uint32_t)lpv->grid.cells[0], LOCAL),
                 gpu_groups((uint32_t)lpv->grid.cells[1], LOCAL), (uint32_t)lpv->grid.cells[2]);
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
    gpu_scope_begin(cmd, "lpv.inject");
    gpu_fill_buffer(cmd, lpv->sums, 0, cells * LPV_CELL_BYTES, 0);
    inject_rsm(lpv, cmd, view);
    inject_emitters(lpv, cmd, view);
    gpu_scope_end(cmd);

    gpu_scope_begin(cmd, "lpv.resolve");
    dispatch_cells(lpv, cmd, lpv->resolve,
                   GPU_BIND(grid_binding(lpv, cmd), { .name = "lpv_sums", .buffer = lpv->sums },
                            { .name = "injected_red", .image = lpv->injected.colour[0] },
                            { .name = "injected_green", .image = lpv->injected.colour[1] },
                            { .name = "injected_blue", .image = lpv->injected.colour[2] }));
    gpu_scope_end(cmd);
}

static void record_step(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                        const struct lpv_volume *before, const struct lpv_volume *after)
{
    const struct lpv_volume *injected = &lpv->injected;
    dispatch_cells(lpv, cmd, pipeline,
                   GPU_BIND(grid_binding(lpv, cmd),
                            { .name = "injected_red", .image = injected->colour[0] },
                            { .name = "injected_green", .image = injected->colour[1] },
                            { .name = "injected_blue", .image = injected->colour[2] },
                            { .name = "before_red", .image = before->colour[0] },
                            { .name = "before_green", .image = before->colour[1] },
                            { .name = "before_blue", .image = before->colour[2] },
                            { .name = "after_red", .image = after->colour[0] },
                            { .name = "after_green", .image = after->colour[1] },
                            { .name = "after_blue", .image = after->colour[2] }));
}

void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd)
{
    const int last = lpv->options.steps - 1;
    gpu_scope_begin(cmd, "lpv.propagate");
    for (int i = 0; i <= last; i++) {
        const struct lpv_volume *before = i == 0 ? &lpv->injected : &lpv->steps[(i - 1) % 2];
        const struct lpv_volume *after = i == last ? &lpv->light : &lpv->steps[i % 2];
        record_step(lpv, cmd, i == last ? lpv->finish : lpv->propagate, before, after);
    }
    gpu_scope_end(cmd);
}

void lpv_record_application(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct lpv_volume *light = &lpv->light;
    gpu_scope_begin(cmd, "lpv.apply");
    gpu_dispatch(
        cmd, lpv->apply,
        GPU_BIND(grid_binding(lpv, cmd), view->constants_binding,
                 { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                 { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                 { .name = "light_red", .image = light->colour[0], .sampler = lpv->linear },
                 { .name = "light_green", .image = light->colour[1], .sampler = lpv->linear },
                 { .name = "light_blue", .image = light->colour[2], .sampler = lpv->linear },
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
    const struct lpv_volume *shown = what == LPV_VIEW_PROPAGATED ? &lpv->light : &lpv->injected;
    gpu_scope_begin(cmd, "lpv.debug");
    gpu_dispatch(cmd, lpv->debug,
                 GPU_BIND(grid_binding(lpv, cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "shown_red", .image = shown->colour[0] },
                          { .name = "shown_green", .image = shown->colour[1] },
                          { .name = "shown_blue", .image = shown->colour[2] },
                          { .name = "picture", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, LOCAL),
                 gpu_groups(view->height, LOCAL), 1);
    gpu_scope_end(cmd);
}
