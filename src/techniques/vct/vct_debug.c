#include "techniques/vct/vct_debug.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

static void march(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                  const struct frame_view *view, struct vct_view_push push, gpu_image out)
{
    gpu_dispatch(cmd, vct->debug,
                 GPU_BIND(vct_grid_binding(vct, clip, cmd), vct_clipmap_binding(vct, cmd),
                          view->constants_binding, VCT_BOTH_SETS(clip),
                          { .name = "static_surfaces", .image = clip->static_set.surfaces },
                          { .name = "dynamic_surfaces", .image = clip->dynamic_set.surfaces },
                          { .name = "result_image", .image = out }, vct_svo_binding(vct, cmd),
                          { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
                 &push, sizeof push, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

// Marches each view ray through the levels: from the coarsest to the finest and back.
void vct_record_debug(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t which, gpu_image out)
{
    // Tone mapping expects scaled radiance: a reflectance of 1 is displayed as a brightly lit
    // surface.
    struct vct_view_push push = { .view = which, .reflectance_scale = 4.0f };
    const int last = vct->clip_count - 1;
    gpu_scope_begin(cmd, "debug");
    for (int i = 0; i <= 2 * last; i++) {
        push.march = i <= last ? VCT_MARCH_INTO : VCT_MARCH_OUT;
        if (i == 0) push.march |= VCT_MARCH_FIRST;
        if (i == 2 * last) push.march |= VCT_MARCH_LAST;
        march(vct, &vct->clips[i <= last ? i : 2 * last - i], cmd, view, push, out);
    }
    gpu_scope_end(cmd);
}
