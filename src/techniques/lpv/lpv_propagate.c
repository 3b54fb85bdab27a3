// Propagation: the steps of one cascade, with bounces between them.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

static void record_step(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                        gpu_image injected, gpu_image before, gpu_image after)
{
    // Without geometry the shader does not read the transmittance; any buffer will do.
    const gpu_buffer transmittance =
        lpv->options.geometry == LPV_GEOMETRY_OFF ? lpv->volumes.sums : lpv->volumes.transmittance;
    const uint32_t run = lpv->options.neighbours == LPV_TWENTY_SIX ? LPV_RUN : 1;
    lpv_dispatch_cells(lpv, cmd, pipeline, run,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_transmittance", .buffer = transmittance },
                                { .name = "injected", .image = injected },
                                { .name = "before", .image = before },
                                { .name = "after", .image = after }));
}

// Output of the step after which `left` remain: `light` for the last, the ping-pong images for the
// others. With half precision `light` is one of the two.
static gpu_image step_target(const struct lpv *lpv, int left)
{
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    if (left == 0 || (half && left % 2 == 0)) return lpv->volumes.light;
    return lpv->volumes.steps[half ? 0 : (left + 1) % 2];
}

// The first step is unoccluded (Martin 2012, sec. 3.2.3), or surfaces would shade the light that
// they send: A = S + FS + TFS + T²FS + …, F the unoccluded step. With F = T + H, where H propagates
// the occluded light, this is A = S' + TA for S' = S + HS, starting at A = S: identical steps with
// a larger source. Returns the image of S', which is not an image of the first step.
static gpu_image record_source(struct lpv *lpv, struct gpu_cmd *cmd, int left)
{
    const gpu_image injected = lpv->volumes.injected;
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return injected;
    const gpu_image source = step_target(lpv, left + 1);
    record_step(lpv, cmd, lpv->pipelines.propagate_occluded, injected, injected, source);
    return source;
}

// Adds the light that surfaces reflect to the source; its first step is unoccluded too.
static gpu_image record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived)
{
    const struct lpv_volumes *v = &lpv->volumes;
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    const gpu_image other = half ? v->light : v->steps[1];
    const gpu_image unused = arrived.id == v->steps[0].id ? other : v->steps[0];
    lpv_record_bounce(lpv, cmd, arrived);
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return v->sent;
    record_step(lpv, cmd, lpv->pipelines.propagate_occluded, v->sent, v->reflected, unused);
    gpu_copy_image(cmd, v->sent, unused);
    return v->sent;
}

// A finer cascade starts from the coarser light `before`, which holds all bounces. Its surfaces
// reflect that light once, and the reflected light joins the source.
static gpu_image record_reflection(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before)
{
    const struct lpv_volumes *v = &lpv->volumes;
    lpv_record_bounce(lpv, cmd, before);
    if (lpv->options.geometry == LPV_GEOMETRY_OFF) return v->sent;
    record_step(lpv, cmd, lpv->pipelines.propagate_occluded, v->sent, v->sent, v->reflected);
    return v->reflected;
}

static void record_steps(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before, gpu_image source)
{
    for (int left = lpv->options.steps - 1; left >= 0; left--) {
        const gpu_image after = step_target(lpv, left);
        record_step(lpv, cmd, lpv->pipelines.propagate, source, before, after);
        if (source.id == step_target(lpv, left + 1).id) { // the next step overwrites it
            gpu_copy_image(cmd, lpv->volumes.injected, source);
            source = lpv->volumes.injected;
        }
        before = after;
        if (lpv_bounces_after(lpv, left)) source = record_bounce(lpv, cmd, after);
    }
}

// The only grid, or the coarsest cascade.
static void propagate_coarsest(struct lpv *lpv, struct gpu_cmd *cmd)
{
    const gpu_image source = record_source(lpv, cmd, lpv->options.steps - 1);
    record_steps(lpv, cmd, lpv->volumes.injected, source);
}

static void propagate_finer(struct lpv *lpv, struct gpu_cmd *cmd)
{
    const gpu_image before = step_target(lpv, lpv->options.steps), injected = lpv->volumes.injected;
    if (lpv->options.bounces > 0) {
        lpv_record_refinement(lpv, cmd, before);
        record_steps(lpv, cmd, before, record_reflection(lpv, cmd, before));
        return;
    }
    const gpu_image source = record_source(lpv, cmd, lpv->options.steps - 1);
    if (source.id != injected.id) gpu_copy_image(cmd, injected, source);
    lpv_record_refinement(lpv, cmd, before);
    record_steps(lpv, cmd, before, injected);
}

void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "propagate");
    if (lpv->coarser)
        propagate_finer(lpv, cmd);
    else
        propagate_coarsest(lpv, cmd);
    gpu_scope_end(cmd);
}
