#include "techniques/vct/cones/specular.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include <math.h>

static gpu_image averaged(const struct vct *vct)
{
    return vct->pixels->averaged[vct->options.temporal ? vct->temporal->newest : 0];
}

static void average(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                    const struct gpu_binding *set)
{
    const struct vct_temporal *t = vct->options.temporal ? vct->temporal : NULL;
    const struct vct_history_params none = { .known = 0 };
    gpu_dispatch(
        cmd, vct->lobe_average,
        GPU_BIND(
            *set, FRAME_SURFACE_BINDINGS(view),
            gpu_transient(cmd, "vct_history", t ? &t->params : &none, sizeof none),
            { .name = "motion", .image = t ? view->layers[FRAME_MOTION] : vct->pixels->arriving },
            { .name = "last_averaged", .image = vct->pixels->averaged[t ? 1 - t->newest : 0] },
            { .name = "last_surface",
              .image = t ? t->surface[1 - t->newest] : vct->pixels->arriving },
            { .name = "arriving", .image = vct->pixels->arriving },
            { .name = "averaged", .image = averaged(vct) }),
        NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D), gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

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
        .stride = vct->options.temporal && vct_has_rays(options) ? 2 : 1,
        .turn = vct->options.temporal ? vct->temporal->frame : 0,
        .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0,
    };
    const struct gpu_binding set = gpu_transient(cmd, "vct_specular", &params, sizeof params);
    const bool rays = vct_has_rays(&vct->options);
    const gpu_image arriving = vct->pixels->arriving;
    const uint32_t across = gpu_groups(view->width, VCT_LOCAL_2D),
                   down = gpu_groups(view->height, VCT_LOCAL_2D);
    gpu_scope_begin(cmd, "specular");
    gpu_dispatch(cmd, vct->specular[vct_light_variant(vct, view)],
                 GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd), vct_clipmap_binding(vct, cmd),
                          set, FRAME_SURFACE_BINDINGS(view), view->environment_binding,
                          { .name = "light", .image = vct->light, .sampler = vct->linear },
                          { .name = "arriving", .image = arriving },
                          VCT_RAY_BINDINGS(vct, &vct->clips[0]), vct_svo_binding(vct, cmd),
                          { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
                 NULL, 0,
                 VCT_REFLECT_SIDE * VCT_REFLECT_SIDE *
                     gpu_groups(view->width, VCT_REFLECT_SIDE * VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_REFLECT_SIDE * VCT_LOCAL_2D), 1);
    if (rays) average(vct, cmd, view, &set);
    gpu_dispatch(cmd, vct->reflect,
                 GPU_BIND(set, FRAME_SURFACE_BINDINGS(view),
                          { .name = "irradiance", .image = vct_result(vct, view) },
                          { .name = "arriving", .image = rays ? averaged(vct) : arriving },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 NULL, 0, across, down, 1);
    gpu_scope_end(cmd);
}
