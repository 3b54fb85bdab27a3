// The estimate and its filters: temporal accumulation, blur, upsampling.
#include "techniques/common/screen_ao.h"

#include "technique_shaders.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

enum { LOCAL = 8, BLUR_ROW = 4 };
enum { ROTATIONS = 16 }; // of the pattern, in pixels of a tile and in frames

static uint32_t step_of(const struct screen_ao_options *options)
{
    return options->half_resolution ? 2 : 1;
}

static uint32_t work_size(const struct screen_ao_options *options, uint32_t size)
{
    return gpu_groups(size, step_of(options));
}

// ---- objects

static bool needs_upsample(const struct screen_ao_options *options)
{
    return options->half_resolution || !options->blur;
}

// Views share the memory of the estimate, which one at a time uses, but not of the history.
void screen_ao_objects(const struct screen_ao_options *o, size_t base, uint32_t width,
                       uint32_t height, struct gpu_objects *out)
{
    const struct gpu_image_desc estimate = { .format = GPU_RG32F,
                                             .width = work_size(o, width),
                                             .height = work_size(o, height),
                                             .usage = GPU_SAMPLED | GPU_STORAGE,
                                             .alias = "ao.estimate" };
    const struct gpu_image_desc none = { .width = 0 };
    struct gpu_image_desc scratch = estimate, history = estimate;
    scratch.alias = "ao.scratch";
    history.alias = NULL;
    history.format = GPU_RGBA32F;
    if (!o->blur) scratch = none;
    if (!o->temporal) history = none;
    const struct gpu_shader *blur_y = o->half_resolution ? &shader_common_screen_ao_blur_y_half_comp
                                                         : &shader_common_screen_ao_blur_y_comp;
    out->constants[SCREEN_AO_CONSTANT_STEP] =
        (struct gpu_constant){ SCREEN_AO_CONSTANT_STEP, step_of(o) };
#define MEMBER(member) offsetof(struct screen_ao, member), .consts = SCREEN_AO_STEP
    GPU_ADD(out, base,
            { GPU_IMAGE, "estimate", MEMBER(estimate), .of_view = true, .image = estimate },
            { GPU_IMAGE, "scratch", MEMBER(scratch), .of_view = true, .image = scratch },
            { GPU_IMAGE, "history", MEMBER(history[0]), .of_view = true, .image = history },
            { GPU_IMAGE, "history", MEMBER(history[1]), .of_view = true, .image = history },
            { GPU_PIPELINE, "blur_x", MEMBER(blur_x),
              .shader = o->blur ? &shader_common_screen_ao_blur_x_comp : NULL },
            { GPU_PIPELINE, "blur_y", MEMBER(blur_y), .shader = o->blur ? blur_y : NULL },
            { GPU_PIPELINE, "upsample", MEMBER(upsample),
              .shader = needs_upsample(o) ? &shader_common_screen_ao_upsample_comp : NULL },
            { GPU_PIPELINE, "temporal", MEMBER(temporal),
              .shader = o->temporal ? &shader_common_screen_ao_temporal_comp : NULL });
#undef MEMBER
}

// ---- a frame

// Pixels per unit of the angle's tangent, or per metre in orthographic views.
static float focal_px(const struct frame_camera *camera, const struct frame_view *view)
{
    return 1.0f / frame_camera_pixel(camera, view->width, view->height);
}

static vec4s scale_of(const struct frame_camera *camera, float focal)
{
    if (camera->orthographic)
        return (vec4s){ { focal, 0.0f, focal * (camera->far_m - camera->near_m), 0.0f } };
    return (vec4s){ { 0.0f, focal / camera->near_m, 0.0f, focal } };
}

// A new size begins with a cut of the camera.
static void use_history(struct screen_ao *ao, const struct frame_view *view)
{
    struct screen_ao_params *p = &ao->params;
    const bool known = ao->has_history && !view->camera_cut && view->index > 0;
    ao->number = known ? ao->number + 1 : 0;
    // The golden-ratio sequence of rotations continues from frame to frame.
    p->rotation = fmodf(0.61803399f * (float)(ROTATIONS * (ao->number % ROTATIONS)), 1.0f);
    p->has_history = known;
    p->jitter_step_x = view->constants->jitter_step_x;
    p->jitter_step_y = view->constants->jitter_step_y;
    if (known) {
        p->previous_scale = scale_of(&ao->previous, focal_px(&ao->previous, view));
        p->previous_depth_of_distance = frame_camera_depth_of_distance(&ao->previous);
    }
    ao->previous = view->camera;
    ao->has_history = true;
    ao->newest = 1 - ao->newest;
}

void screen_ao_invalidate(struct screen_ao *ao)
{
    ao->has_history = false;
}

void screen_ao_begin(struct screen_ao *ao, struct screen_ao_options options,
                     const struct frame_view *view, float radius_m, float reach)
{
    const struct frame_camera *camera = &view->camera;
    const float width = (float)view->width, height = (float)view->height;
    const float focal = focal_px(camera, view);
    ao->options = options;
    ao->params = (struct screen_ao_params){
        .distance_of_depth = frame_camera_distance_of_depth(camera),
        .right = frame_camera_right(camera),
        .down = glms_vec3_negate(camera->up),
        .forward = camera->forward,
        .scale = scale_of(camera, focal),
        .focal_px = focal,
        .perspective = camera->orthographic ? 0.0f : 1.0f,
        .radius_m = radius_m,
        .max_radius_px = reach * height,
        .center_x = width * camera->left / (camera->left - camera->right),
        .center_y = height * camera->top / (camera->top - camera->bottom),
        .width = view->width,
        .height = view->height,
        .work_width = work_size(&options, view->width),
        .work_height = work_size(&options, view->height),
    };
    if (options.temporal) use_history(ao, view);
}

struct gpu_binding screen_ao_binding(const struct screen_ao *ao, struct gpu_cmd *cmd)
{
    return gpu_transient(cmd, "screen_ao", &ao->params, sizeof ao->params);
}

void screen_ao_estimate(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view,
                        const char *name, gpu_pipeline pipeline, const struct gpu_binding *extra,
                        int extra_count)
{
    struct gpu_binding bindings[4 + SCREEN_AO_EXTRA] = {
        screen_ao_binding(ao, cmd),
        { .name = "depth", .image = view->layers[FRAME_DEPTH] },
        { .name = "normal", .image = view->layers[FRAME_NORMAL] },
        { .name = "estimate", .image = ao->estimate },
    };
    assert(extra_count <= SCREEN_AO_EXTRA);
    memcpy(bindings + 4, extra, (size_t)extra_count * sizeof *extra);
    gpu_scope_begin(cmd, name);
    gpu_clear_image(cmd, ao->estimate, (const float[4]){ 1.0f }); // pixels without a surface
    gpu_dispatch(cmd, pipeline, bindings, 4 + extra_count, NULL, 0,
                 gpu_groups(ao->params.work_width, LOCAL),
                 gpu_groups(ao->params.work_height, LOCAL * SCREEN_AO_ROWS), 1);
    gpu_scope_end(cmd);
}

static gpu_image estimate_to_filter(const struct screen_ao *ao)
{
    return ao->options.temporal ? ao->history[ao->newest] : ao->estimate;
}

static void record_temporal(const struct screen_ao *ao, struct gpu_cmd *cmd,
                            const struct frame_view *view)
{
    gpu_scope_begin(cmd, "temporal");
    gpu_dispatch(cmd, ao->temporal,
                 GPU_BIND(screen_ao_binding(ao, cmd), { .name = "estimate", .image = ao->estimate },
                          { .name = "motion", .image = view->layers[FRAME_MOTION] },
                          { .name = "history", .image = ao->history[1 - ao->newest] },
                          { .name = "target", .image = ao->history[ao->newest] }),
                 NULL, 0, gpu_groups(ao->params.work_width, LOCAL),
                 gpu_groups(ao->params.work_height, LOCAL), 1);
    gpu_scope_end(cmd);
}

static void record_blur(const struct screen_ao *ao, struct gpu_cmd *cmd, gpu_image visibility)
{
    const struct gpu_binding params = screen_ao_binding(ao, cmd);
    gpu_scope_begin(cmd, "blur");
    gpu_dispatch(cmd, ao->blur_x,
                 GPU_BIND(params, { .name = "source", .image = estimate_to_filter(ao) },
                          { .name = "target", .image = ao->scratch }),
                 NULL, 0, gpu_groups(ao->params.work_width, LOCAL * BLUR_ROW),
                 gpu_groups(ao->params.work_height, LOCAL), 1);
    gpu_dispatch(cmd, ao->blur_y,
                 GPU_BIND(params, { .name = "source", .image = ao->scratch },
                          { .name = "target", .image = ao->estimate },
                          { .name = "visibility", .image = visibility }),
                 NULL, 0, gpu_groups(ao->params.work_width, LOCAL),
                 gpu_groups(ao->params.work_height, LOCAL * BLUR_ROW), 1);
    gpu_scope_end(cmd);
}

static void record_upsample(const struct screen_ao *ao, struct gpu_cmd *cmd,
                            const struct frame_view *view)
{
    const gpu_image source = ao->options.blur ? ao->estimate : estimate_to_filter(ao);
    gpu_scope_begin(cmd, "upsample");
    gpu_dispatch(cmd, ao->upsample,
                 GPU_BIND(screen_ao_binding(ao, cmd), { .name = "source", .image = source },
                          { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                          { .name = "visibility", .image = view->layers[FRAME_VISIBILITY] }),
                 NULL, 0, gpu_groups(ao->params.width, LOCAL), gpu_groups(ao->params.height, LOCAL),
                 1);
    gpu_scope_end(cmd);
}

void screen_ao_record(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (ao->options.temporal) record_temporal(ao, cmd, view);
    if (ao->options.blur) record_blur(ao, cmd, view->layers[FRAME_VISIBILITY]);
    if (needs_upsample(&ao->options)) record_upsample(ao, cmd, view);
}
