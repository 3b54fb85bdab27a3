// The stages of a frame: prepare, inject, propagate, apply.
#include "techniques/lpv/lpv_state.h"

static const float Y0 = 0.282094792f; // √(1/4π)

// Of a cell that the sky's radiance L comes to from everywhere: 4π I, L = I (w a) / a³
// (lpv_apply.comp).
static vec3s sky_flux(const struct lpv *lpv, const struct frame_view *view)
{
    const float mean_way = (float)lpv_mean_way((enum lpv_scheme)lpv->options.neighbours);
    const float cell_m = lpv->grid.cell_m;
    if (!lpv->options.sky) return vec3_of(0, 0, 0);
    return glms_vec3_scale(view->constants->sky, 4.0f * GLM_PIf * cell_m * cell_m / mean_way);
}

static struct lpv_lights lights_of(const struct lpv *lpv, const struct frame_view *view)
{
    return (struct lpv_lights){
        .faces = view->rsm_faces,
        .face_count = view->rsm_face_count,
        .rsm_size = view->rsm_size,
        .emitters = view->emitters,
        .emitter_count = lpv->options.emitters ? view->emitter_count : 0,
        .bounces = lpv->options.bounces,
    };
}

static struct lpv_params params_of(const struct lpv *lpv, const struct frame_view *view,
                                   const struct lpv_scale *scale)
{
    const struct lpv_options *options = &lpv->options;
    const struct lpv_grid *grid = &lpv->grid;
    const enum lpv_scheme scheme = (enum lpv_scheme)options->neighbours;
    const struct lpv_step step =
        lpv_step_of(scheme, (enum lpv_lobe)options->lobe, (double)options->focus);
    const float mean_way = (float)lpv_mean_way(scheme); // see lpv_apply.comp
    return (struct lpv_params){
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
        .sky = glms_vec3_scale(sky_flux(lpv, view), Y0 * scale->grid_from_flux),
        .fixed_from_flux = scale->fixed_from_flux,
        .grid_from_fixed = scale->grid_from_flux / scale->fixed_from_flux,
        .irradiance_scale =
            options->gain * mean_way / (grid->cell_m * grid->cell_m * scale->grid_from_flux),
        .mean_way = mean_way,
        .offset_m = options->offset * grid->cell_m,
        .bounce_offset =
            options->offset * (lpv->coarser ? lpv->coarser->grid.cell_m / grid->cell_m : 1.0f),
        .window = options->window,
        .blocking = options->blocking,
        .damping = options->damping,
        .rsm_size = view->rsm_size,
        .width = view->width,
        .height = view->height,
        .emitter_count = (uint32_t)lights_of(lpv, view).emitter_count,
        .held = lpv->coarser ? grid->open : 0,
    };
}

bool lpv_prepare(struct lpv *lpv, const struct frame_view *view)
{
    struct lpv_lights lights = lights_of(lpv, view);
    struct lpv_scale scale;
    lpv->lit = lpv_cascades_place(lpv, view);
    if (!lpv->lit) return false;
    const struct lpv *coarsest = lpv;
    while (coarsest->coarser) coarsest = coarsest->coarser;
    lights.sky_flux = sky_flux(coarsest, view);
    lpv->lit = lpv_scale_of(&lights, &scale);
    if (!lpv->lit) return false;
    for (struct lpv *level = lpv; level; level = level->coarser)
        level->params = params_of(level, view, &scale);
    return true;
}

struct gpu_binding lpv_grid_binding(struct lpv *lpv, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "lpv_grid", &lpv->params, sizeof lpv->params);
}

void lpv_dispatch_cells(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline, uint32_t run,
                        const struct gpu_binding *bindings, int count)
{
    gpu_dispatch(cmd, pipeline, bindings, count, NULL, 0,
                 gpu_groups((uint32_t)lpv->grid.cells[0], LPV_LOCAL),
                 gpu_groups((uint32_t)lpv->grid.cells[1], LPV_LOCAL),
                 gpu_groups((uint32_t)lpv->grid.cells[2], run));
}

static void inject_rsm(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const uint32_t groups = gpu_groups(view->rsm_size, LPV_LOCAL * LPV_TEXELS);
    if (view->rsm_face_count == 0) return;
    gpu_dispatch(cmd, lpv->inject,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->rsm_faces_binding,
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
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->emitters_binding,
                          { .name = "lpv_sums", .buffer = lpv->sums }),
                 NULL, 0, gpu_groups(lpv->params.emitter_count, LPV_EMITTERS_LOCAL), 1, 1);
}

// From sums to the injected light.
static void resolve(struct lpv *lpv, struct gpu_cmd *cmd)
{
    lpv_dispatch_cells(lpv, cmd, lpv->resolve, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_sums", .buffer = lpv->sums },
                                { .name = "injected", .image = lpv->injected }));
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
    resolve(lpv, cmd);
    gpu_scope_end(cmd);
}

static void record_step(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                        gpu_image injected, gpu_image before, gpu_image after)
{
    // Where there are no shares, anything: nothing reads it.
    const gpu_buffer shares =
        lpv->options.geometry == LPV_GEOMETRY_OFF ? lpv->sums : lpv->geometry.shares;
    const uint32_t run = lpv->options.neighbours == LPV_TWENTY_SIX ? LPV_RUN : 1;
    lpv_dispatch_cells(
        lpv, cmd, pipeline, run,
        GPU_BIND(lpv_grid_binding(lpv, cmd), { .name = "lpv_shares", .buffer = shares },
                 { .name = "injected", .image = injected }, { .name = "before", .image = before },
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

// Nothing is held back in the first step (Martin 2012, sec. 3.2.3), or surfaces would shade what
// they send out themselves: A = S + FS + TFS + T²FS + …, F the free step. With F = T + H, where H
// sends what is held back, this is A = S' + TA for S' = S + HS, from A = S: the same steps with a
// little more injected. Returns where S' is, which is none of the first step's images.
static gpu_image record_held(struct lpv *lpv, struct gpu_cmd *cmd, int left)
{
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return lpv->injected;
    const gpu_image held = step_target(lpv, left + 1);
    record_step(lpv, cmd, lpv->propagate_held, lpv->injected, lpv->injected, held);
    return held;
}

// What surfaces reflect of what has arrived goes on with what was injected, its own first step
// free as well.
static gpu_image record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived)
{
    const struct lpv_bounce *bounce = &lpv->bounce;
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    const gpu_image other = half ? lpv->light : lpv->steps[1];
    const gpu_image unused = arrived.id == lpv->steps[0].id ? other : lpv->steps[0];
    lpv_record_bounce(lpv, cmd, arrived);
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return bounce->sent;
    record_step(lpv, cmd, lpv->propagate_held, bounce->sent, bounce->reflected, unused);
    gpu_copy_image(cmd, bounce->sent, unused);
    return bounce->sent;
}

// One of the finer cascades begins with the coarser one's light, `before`, which has bounced as
// often as it may. What surfaces here reflect of it is sent out with what was injected.
static gpu_image record_reflection(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before)
{
    const struct lpv_bounce *bounce = &lpv->bounce;
    lpv_record_bounce(lpv, cmd, before);
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return bounce->sent;
    record_step(lpv, cmd, lpv->propagate_held, bounce->sent, bounce->sent, bounce->reflected);
    return bounce->reflected;
}

static void record_steps(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before, gpu_image source)
{
    for (int left = lpv->options.steps - 1; left >= 0; left--) {
        const gpu_image after = step_target(lpv, left);
        record_step(lpv, cmd, lpv->propagate, source, before, after);
        if (source.id == step_target(lpv, left + 1).id) { // where the next step writes
            gpu_copy_image(cmd, lpv->injected, source);
            source = lpv->injected;
        }
        before = after;
        if (lpv_bounces_after(lpv, left)) source = record_bounce(lpv, cmd, after);
    }
}

void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd)
{
    const int first = lpv->options.steps - 1;
    gpu_image before = lpv->injected, source;
    gpu_scope_begin(cmd, lpv->names->propagate);
    if (lpv->coarser && lpv->options.bounces > 0) {
        before = step_target(lpv, first + 1);
        lpv_record_refinement(lpv, cmd, before);
        source = record_reflection(lpv, cmd, before);
    } else {
        source = record_held(lpv, cmd, first);
        if (lpv->coarser) {
            if (source.id != lpv->injected.id) gpu_copy_image(cmd, lpv->injected, source);
            source = lpv->injected;
            before = step_target(lpv, first + 1);
            lpv_record_refinement(lpv, cmd, before);
        }
    }
    record_steps(lpv, cmd, before, source);
    gpu_scope_end(cmd);
}

// Of a cascade and all coarser ones that light what it leaves, these first.
static void apply(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                  const struct lpv_grid *finer)
{
    struct lpv_apply_push push = { .open = lpv->grid.open, .coarsest = !lpv->params.held };
    if (finer) {
        push.finer_origin_m = finer->origin_m;
        push.finer_cell_m = finer->cell_m;
        push.finer_cells_x = finer->cells[0];
        push.finer_cells_y = finer->cells[1];
        push.finer_cells_z = finer->cells[2];
        push.finer_open = finer->open;
    }
    if (lpv->params.held) apply(lpv->coarser, cmd, view, &lpv->grid);
    gpu_dispatch(cmd, lpv->options.damping > 0.0f ? lpv->apply_damped : lpv->apply,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "light", .image = lpv->light, .sampler = lpv->linear },
                          { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
                 &push, sizeof push, gpu_groups(view->width, LPV_LOCAL),
                 gpu_groups(view->height, LPV_LOCAL), 1);
}

void lpv_record_application(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, lpv->names->apply);
    apply(lpv, cmd, view, NULL);
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
    const gpu_image geometry =
        lpv->options.geometry == LPV_GEOMETRY_OFF ? shown : lpv->geometry.volume;
    gpu_scope_begin(cmd, lpv->names->debug);
    resolve(lpv, cmd); // propagation may have added what geometry held back
    gpu_dispatch(cmd, lpv->debug,
                 GPU_BIND(lpv_grid_binding(lpv, cmd), view->constants_binding,
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                          { .name = "geometry", .image = geometry, .sampler = lpv->linear },
                          { .name = "volume", .image = shown },
                          { .name = "picture", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, LPV_LOCAL),
                 gpu_groups(view->height, LPV_LOCAL), 1);
    gpu_scope_end(cmd);
}
