// Propagation: the steps of one cascade, with bounces between them.
#include "techniques/lpv/lpv_stages.h"

#include "techniques/lpv/lpv_bindings.h"

static void record_step(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image injected, gpu_image before,
                        gpu_image after)
{
    // Without geometry the shader does not read the transmittance; any buffer will do.
    const gpu_buffer transmittance =
        lpv->options.geometry == LPV_GEOMETRY_OFF ? lpv->volumes.sums : lpv->volumes.transmittance;
    const uint32_t run = lpv->options.neighbours == LPV_TWENTY_SIX ? LPV_RUN : 1;
    lpv_dispatch_cells(lpv, cmd, lpv->pipelines.propagate, run,
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

static void record_steps(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image before, gpu_image source)
{
    for (int left = lpv->options.steps - 1; left >= 0; left--) {
        const gpu_image after = step_target(lpv, left);
        record_step(lpv, cmd, source, before, after);
        before = after;
        if (!lpv_bounces_after(lpv, left)) continue;
        lpv_record_bounce(lpv, cmd, after);
        source = lpv->volumes.sent;
    }
}

// A finer cascade starts from the coarser light, which holds all bounces; its surfaces reflect that
// light once. The only grid, or the coarsest cascade, starts from the injected light.
void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd)
{
    gpu_image before = lpv->volumes.injected, source = before;
    gpu_scope_begin(cmd, "propagate");
    if (lpv->coarser) {
        before = step_target(lpv, lpv->options.steps);
        lpv_record_refinement(lpv, cmd, before);
        if (lpv->options.bounces > 0) {
            lpv_record_bounce(lpv, cmd, before);
            source = lpv->volumes.sent;
        }
    }
    record_steps(lpv, cmd, before, source);
    gpu_scope_end(cmd);
}
