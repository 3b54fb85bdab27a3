// Propagation: the steps of one cascade, with bounces between them.
#include "techniques/lpv/propagate/propagate.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"

static void record_step(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                        const struct lpv_cascade *cascade, gpu_image injected, gpu_image before,
                        gpu_image after)
{
    // Without geometry the shader does not read the transmittance; any buffer will do.
    const gpu_buffer transmittance = frame->options->geometry == LPV_GEOMETRY_OFF
                                         ? frame->injection->sums
                                         : cascade->geometry.transmittance;
    const uint32_t run = frame->options->neighbours == LPV_TWENTY_SIX ? LPV_RUN : 1;
    lpv_dispatch_cells(cascade, frame->cmd, propagation->propagate, run,
                       GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                                { .name = "lpv_transmittance", .buffer = transmittance },
                                { .name = "injected", .image = injected },
                                { .name = "before", .image = before },
                                { .name = "after", .image = after }));
}

// Output of the step after which `left` remain: the cascade's light for the last, the ping-pong
// images for the others. With half precision the light is one of the two.
static gpu_image step_target(const struct lpv_propagation *propagation,
                             const struct lpv_frame *frame, const struct lpv_cascade *cascade,
                             int left)
{
    const bool half = frame->options->precision == LPV_PRECISION_HALF;
    if (left == 0 || (half && left % 2 == 0)) return cascade->light;
    return propagation->steps[half ? 0 : (left + 1) % 2];
}

static void record_steps(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                         const struct lpv_cascade *cascade, gpu_image before, gpu_image source)
{
    for (int left = cascade->steps - 1; left >= 0; left--) {
        const gpu_image after = step_target(propagation, frame, cascade, left);
        record_step(propagation, frame, cascade, source, before, after);
        before = after;
        if (!lpv_bounces_after(frame, cascade, left)) continue;
        lpv_record_bounce(propagation, frame, cascade, after);
        source = propagation->sent;
    }
}

// A finer cascade starts from the coarser light, which holds all bounces; its surfaces reflect that
// light once. The only grid, or the coarsest cascade, starts from the injected light.
void lpv_record_propagation(const struct lpv_propagation *propagation,
                            const struct lpv_frame *frame, const struct lpv_cascade *cascade)
{
    gpu_image before = frame->injection->injected, source = before;
    gpu_scope_begin(frame->cmd, "propagate");
    if (cascade->coarser) {
        before = step_target(propagation, frame, cascade, cascade->steps);
        lpv_record_refinement(propagation, frame, cascade, before);
        if (frame->options->bounces > 0) {
            lpv_record_bounce(propagation, frame, cascade, before);
            source = propagation->sent;
        }
    }
    record_steps(propagation, frame, cascade, before, source);
    gpu_scope_end(frame->cmd);
}
