// Further bounces: the surfaces by cell, kept while nothing moves, and their injection.
#include "techniques/lpv/lpv_bounce.h"

#include "techniques/lpv/lpv_state.h"

#include "frame/scene_gpu.h"
#include "technique_shaders.h"

enum { CELL_BYTES = 6 * 4 * 4 };

bool lpv_surfaces_create(struct lpv *lpv)
{
    if (lpv->options.bounces == 0) return true;
    const size_t dim = (size_t)lpv->options.dim;
    const struct gpu_buffer_desc desc = { .name = lpv->names->surfaces,
                                          .bytes = dim * dim * dim * CELL_BYTES,
                                          .usage = GPU_BUFFER_STORAGE };
    return gpu_buffer_create(lpv->gpu, &desc, &lpv->bounce.surfaces);
}

static bool create_pipelines(struct lpv *lpv)
{
    struct lpv_bounce *b = &lpv->bounce;
    const struct gpu_constant is_masked = { 4, 1 }; // frame/scene.glsl
    const struct gpu_constant constants[] = {
        { LPV_CONSTANT_BANDS, (uint32_t)lpv->options.bands },
        { LPV_CONSTANT_HALF, lpv->options.precision == LPV_PRECISION_HALF },
    };
    return gpu_compute_pipeline_create(lpv->gpu, lpv->names->surfaces, &shader_lpv_surfaces_comp,
                                       NULL, 0, &b->opaque) &&
           gpu_compute_pipeline_create(lpv->gpu, lpv->names->surfaces, &shader_lpv_surfaces_comp,
                                       &is_masked, 1, &b->masked) &&
           gpu_compute_pipeline_create(lpv->gpu, lpv->names->reflected, &shader_lpv_bounce_comp,
                                       constants, 2, &b->bounce);
}

bool lpv_bounce_create(struct lpv *lpv)
{
    const struct lpv_names *name = lpv->names;
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    const enum gpu_format format = half ? GPU_RGBA16F : GPU_RGBA32F;
    if (lpv->options.bounces == 0) return true;
    return lpv_surfaces_create(lpv) && create_pipelines(lpv) &&
           lpv_create_volume(lpv, name->reflected, format, &lpv->bounce.reflected) &&
           lpv_create_volume(lpv, name->sent, format, &lpv->bounce.sent);
}

void lpv_bounce_destroy(struct lpv *lpv)
{
    struct lpv_bounce *b = &lpv->bounce;
    gpu_image_destroy(lpv->gpu, &b->reflected);
    gpu_image_destroy(lpv->gpu, &b->sent);
    gpu_buffer_destroy(lpv->gpu, &b->surfaces);
    gpu_pipeline_destroy(lpv->gpu, &b->opaque);
    gpu_pipeline_destroy(lpv->gpu, &b->masked);
    gpu_pipeline_destroy(lpv->gpu, &b->bounce);
}

uint64_t lpv_bounce_bytes(const struct lpv_options *options)
{
    const uint64_t dim = (uint64_t)options->dim;
    const bool half = options->precision == LPV_PRECISION_HALF;
    const uint64_t texel = (uint64_t)gpu_format_bytes(half ? GPU_RGBA16F : GPU_RGBA32F);
    if (options->bounces == 0) return 0;
    return dim * dim * dim *
           ((uint64_t)options->cascades * CELL_BYTES + 2 * texel * lpv_slabs(options));
}

void lpv_record_surfaces(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv_bounce *b = &lpv->bounce;
    if (lpv->options.bounces == 0) return;
    if (b->kept && view->index > 0 && !view->geometry_moved && lpv_grid_equal(&b->grid, &lpv->grid))
        return;
    const int32_t *cells = lpv->grid.cells;
    const size_t count = (size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2];
    const struct gpu_binding own[2] = { lpv_grid_binding(lpv, cmd),
                                        { .name = "lpv_surfaces", .buffer = b->surfaces } };
    gpu_scope_begin(cmd, lpv->names->surfaces);
    gpu_fill_buffer(cmd, b->surfaces, 0, count * CELL_BYTES, 0);
    for (int i = 0; view->scene && i < view->scene->draw_count; i++) {
        const struct scene_draw *draw = &view->scene->draws[i];
        const bool masked = draw->variant & VARIANT_MASKED;
        scene_gpu_dispatch(view->scene, cmd,
                           &(struct scene_dispatch_call){
                               .pipeline = masked ? b->masked : b->opaque,
                               .draw = draw,
                               .bindings = own,
                               .binding_count = 2,
                           });
    }
    gpu_scope_end(cmd);
    b->kept = true;
    b->grid = lpv->grid;
}

bool lpv_bounces_after(const struct lpv *lpv, int left)
{
    const int steps = lpv->options.steps, bounces = lpv->options.bounces, done = steps - left;
    if (lpv->coarser) return false; // it begins with light that has bounced
    // Bounce k of n follows step ⌊k steps / (n + 1)⌋.
    const int parts = bounces + 1;
    return left > 0 && done * parts / steps > (done - 1) * parts / steps;
}

void lpv_record_bounce(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image arrived)
{
    const struct lpv_bounce *b = &lpv->bounce;
    lpv_dispatch_cells(lpv, cmd, b->bounce, 1,
                       GPU_BIND(lpv_grid_binding(lpv, cmd),
                                { .name = "lpv_surfaces", .buffer = b->surfaces },
                                { .name = "injected", .image = lpv->injected },
                                { .name = "arrived", .image = arrived, .sampler = lpv->linear },
                                { .name = "reflected", .image = b->reflected },
                                { .name = "sent", .image = b->sent }));
}
