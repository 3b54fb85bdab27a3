#include "techniques/vct/vct_debug.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

static void march(gpu_pipeline pipeline, const struct vct_frame *frame, int level,
                  struct vct_view_push push, gpu_image out)
{
    const struct frame_view *view = frame->view;
    const struct vct_level_voxels *voxels = &frame->voxels->levels[level];
    gpu_dispatch(frame->cmd, pipeline,
                 GPU_BIND(vct_grid_binding(frame, level), vct_clipmap_binding(frame),
                          view->constants_binding, VCT_BOTH_SETS(voxels), VCT_LIT_BINDINGS(frame),
                          { .name = "static_surfaces", .image = voxels->static_set.surfaces },
                          { .name = "dynamic_surfaces", .image = voxels->dynamic_set.surfaces },
                          { .name = "result_image", .image = out }, vct_svo_binding(frame),
                          { .name = "vct_svo_nodes", .buffer = frame->svo->nodes }),
                 &push, sizeof push, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

// Marches each view ray through the levels: from the coarsest to the finest and back.
void vct_record_debug(gpu_pipeline pipeline, const struct vct_frame *frame, uint32_t which,
                      gpu_image out)
{
    // Tone mapping expects scaled radiance: a reflectance of 1 is displayed as a brightly lit
    // surface.
    struct vct_view_push push = { .view = which, .reflectance_scale = 4.0f };
    const int last = frame->clipmap->count - 1;
    gpu_scope_begin(frame->cmd, "debug");
    for (int i = 0; i <= 2 * last; i++) {
        push.march = i <= last ? VCT_MARCH_INTO : VCT_MARCH_OUT;
        if (i == 0) push.march |= VCT_MARCH_FIRST;
        if (i == 2 * last) push.march |= VCT_MARCH_LAST;
        march(pipeline, frame, i <= last ? i : 2 * last - i, push, out);
    }
    gpu_scope_end(frame->cmd);
}
