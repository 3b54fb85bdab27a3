#include "techniques/vct/cones/specular.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include <math.h>

void vct_record_specular(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct vct_options *options = &vct->options;
    const struct vct_specular_params params = {
        .tan_half = tanf(options->aperture * (GLM_PIf / 180.0f)),
        .step_size = options->step_size,
        .offset = options->offset,
        .gain = options->gain,
        .texel_m = 2.0f * vct->clips[vct->clip_count - 1].grid.cell_m,
        .last_mip = vct_volume_mips(options) - 1,
        .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0,
    };
    gpu_scope_begin(cmd, "specular");
    gpu_dispatch(
        cmd, vct->specular[vct_has_more_light(vct, view)],
        GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd), vct_clipmap_binding(vct, cmd),
                 gpu_transient(cmd, "vct_specular", &params, sizeof params),
                 FRAME_SURFACE_BINDINGS(view), view->environment_binding,
                 { .name = "irradiance", .image = vct_result(vct, view) },
                 { .name = "light", .image = vct->light, .sampler = vct->linear },
                 { .name = "specular", .image = view->layers[FRAME_SPECULAR] },
                 vct_svo_binding(vct, cmd), { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
        NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D), gpu_groups(view->height, VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
