#include "techniques/lpv/inject/inject.h"

#include "techniques/lpv/lpv_bindings.h"
#include "techniques/lpv/lpv_frame.h"
#include "techniques/lpv/lpv_volumes.h"

static void inject_rsm(const struct lpv_injection *injection, const struct lpv_frame *frame,
                       const struct lpv_cascade *cascade)
{
    const struct frame_view *view = frame->view;
    const uint32_t groups = gpu_groups(view->rsm_size, LPV_LOCAL * LPV_TEXELS);
    if (view->rsm_face_count == 0) return;
    gpu_dispatch(frame->cmd, injection->rsm,
                 GPU_BIND(lpv_grid_binding(cascade, frame->cmd), view->rsm_faces_binding,
                          { .name = "rsm_depth", .image = view->rsm_depth },
                          { .name = "rsm_normal", .image = view->rsm_normal },
                          { .name = "rsm_flux", .image = view->rsm_flux },
                          { .name = "lpv_sums", .buffer = injection->sums },
                          { .name = "lpv_walls", .buffer = lpv_walls(frame, cascade) }),
                 NULL, 0, groups, groups, (uint32_t)view->rsm_face_count);
}

static void inject_emitters(const struct lpv_injection *injection, const struct lpv_frame *frame,
                            const struct lpv_cascade *cascade)
{
    const uint32_t count = cascade->params.emitter_count;
    if (count == 0) return;
    gpu_dispatch(frame->cmd, injection->emitters,
                 GPU_BIND(lpv_grid_binding(cascade, frame->cmd), frame->view->emitters_binding,
                          { .name = "lpv_sums", .buffer = injection->sums },
                          { .name = "lpv_walls", .buffer = lpv_walls(frame, cascade) }),
                 NULL, 0, gpu_groups(count, LPV_EMITTERS_LOCAL), 1, 1);
}

void lpv_record_resolve(const struct lpv_injection *injection, const struct lpv_frame *frame,
                        const struct lpv_cascade *cascade)
{
    lpv_dispatch_cells(cascade, frame->cmd, injection->resolve, 1,
                       GPU_BIND(lpv_grid_binding(cascade, frame->cmd),
                                { .name = "lpv_sums", .buffer = injection->sums },
                                { .name = "injected", .image = injection->injected }));
}

void lpv_record_injection(const struct lpv_injection *injection, const struct lpv_frame *frame,
                          const struct lpv_cascade *cascade)
{
    gpu_scope_begin(frame->cmd, "inject");
    gpu_fill_buffer(frame->cmd, injection->sums, 0,
                    lpv_cell_count(&cascade->grid) * lpv_sum_bytes(frame->options), 0);
    inject_rsm(injection, frame, cascade);
    inject_emitters(injection, frame, cascade);
    gpu_scope_end(frame->cmd);

    gpu_scope_begin(frame->cmd, "resolve");
    lpv_record_resolve(injection, frame, cascade);
    gpu_scope_end(frame->cmd);
}
