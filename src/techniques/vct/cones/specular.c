#include "techniques/vct/cones/specular.h"

#include "techniques/vct/cones/temporal.h"
#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

#include <math.h>

static gpu_image averaged(const struct vct_reflections *images, const struct vct_temporal *t)
{
    return images->averaged[t ? t->newest : 0];
}

static struct vct_specular_params params_of(const struct vct_frame *frame,
                                            const struct vct_temporal *t)
{
    const struct vct_options *options = frame->options;
    return (struct vct_specular_params){
        .tan_half = tanf(options->aperture * (GLM_PIf / 180.0f)),
        .step_size = options->step_size,
        .offset = options->offset,
        .gain = options->gain,
        .texel_m = vct_clipmap_texel_m(frame->clipmap),
        .last_mip = vct_volume_mips(options) - 1,
        .stride = t && vct_has_rays(options) ? 2 : 1,
        .turn = t ? t->frame : 0,
        .traced = options->specular == VCT_SPECULAR_TRACED,
        .has_dielectric = frame->view->layers[FRAME_DIELECTRIC].id != 0,
    };
}

static void trace(const struct vct_specular *specular, const struct vct_frame *frame,
                  const struct gpu_binding *set, gpu_image arriving)
{
    const struct frame_view *view = frame->view;
    gpu_dispatch(frame->cmd, specular->trace[vct_light_variant(frame)],
                 GPU_BIND(vct_grid_binding(frame, 0), vct_clipmap_binding(frame), *set,
                          FRAME_SURFACE_BINDINGS(view), view->environment_binding,
                          { .name = "arriving", .image = arriving }, VCT_TRACE_BINDINGS(frame)),
                 NULL, 0,
                 VCT_REFLECT_SIDE * VCT_REFLECT_SIDE *
                     gpu_groups(view->width, VCT_REFLECT_SIDE * VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_REFLECT_SIDE * VCT_LOCAL_2D), 1);
}

static void average(const struct vct_specular *specular, const struct vct_reflections *images,
                    const struct vct_temporal *t, const struct vct_frame *frame,
                    const struct gpu_binding *set)
{
    const struct frame_view *view = frame->view;
    const struct vct_history_params none = { .known = 0 };
    gpu_dispatch(
        frame->cmd, specular->lobe_average,
        GPU_BIND(
            *set, FRAME_SURFACE_BINDINGS(view),
            gpu_transient(frame->cmd, "vct_history", t ? &t->params : &none, sizeof none),
            { .name = "motion", .image = t ? view->layers[FRAME_MOTION] : images->arriving },
            { .name = "last_averaged", .image = images->averaged[t ? 1 - t->newest : 0] },
            { .name = "last_surface", .image = t ? t->surface[1 - t->newest] : images->arriving },
            { .name = "arriving", .image = images->arriving },
            { .name = "averaged", .image = averaged(images, t) }),
        NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D), gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

// arriving: of rays or a cone, which nothing reads without them.
static void reflect(const struct vct_specular *specular, const struct vct_frame *frame,
                    const struct gpu_binding *set, gpu_image arriving)
{
    const struct frame_view *view = frame->view;
    gpu_dispatch(frame->cmd, specular->reflect,
                 GPU_BIND(*set, FRAME_SURFACE_BINDINGS(view),
                          { .name = "irradiance", .image = vct_result(frame) },
                          { .name = "arriving", .image = arriving },
                          { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
                 NULL, 0, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
}

void vct_record_specular(const struct vct_specular *specular, const struct vct_reflections *images,
                         const struct vct_temporal *temporal, const struct vct_frame *frame)
{
    const struct vct_specular_params params = params_of(frame, temporal);
    const struct gpu_binding set =
        gpu_transient(frame->cmd, "vct_specular", &params, sizeof params);
    const bool rays = vct_has_rays(frame->options);
    gpu_scope_begin(frame->cmd, "specular");
    trace(specular, frame, &set, images->arriving);
    if (rays) average(specular, images, temporal, frame, &set);
    reflect(specular, frame, &set, rays ? averaged(images, temporal) : images->arriving);
    gpu_scope_end(frame->cmd);
}

void vct_record_metals(const struct vct_specular *specular, const struct vct_frame *frame)
{
    const struct vct_specular_params params = params_of(frame, NULL);
    const struct gpu_binding set =
        gpu_transient(frame->cmd, "vct_specular", &params, sizeof params);
    gpu_scope_begin(frame->cmd, "specular");
    reflect(specular, frame, &set, vct_result(frame));
    gpu_scope_end(frame->cmd);
}
