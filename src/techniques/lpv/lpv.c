// Light propagation volumes (Martin 2012, ch. 3; Kaplanyan & Dachsbacher 2010) without the geometry
// volume.
//
// The light that reflective shadow maps see leaving the lit surfaces, and that of emissive
// surfaces, is put into a grid over the scene as spherical harmonics (inject), walks from cell to
// neighbour (propagate), and is looked up by each pixel (apply). One bounce, diffuse, everything
// moving. README.md says what differs from the paper and how good it is.
#include "techniques/lpv/lpv.h"

#include "techniques/lpv/lpv_state.h"

#include "technique_shaders.h"

#include <string.h>

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct lpv_options, __VA_ARGS__)
#include "techniques/lpv/lpv_options.def"
#undef OPTION
};

static const struct technique_debug_view debug_views[] = {
    { "injected", "slices of the grid: the light that lit and emissive surfaces put in" },
    { "propagated", "slices of the grid: the light accumulated over all steps" },
    { "cells",
      "the surfaces coloured by the cell they inject into, bright where light was injected" },
    { NULL, NULL },
};

static bool lpv_check(const struct technique_create *how)
{
    const struct lpv_options *options = how->options;
    if (options->dim % 8 != 0)
        return host_fail(how->host, FAIL_ARGUMENT, "gi lpv: dim=%d is not a multiple of 8",
                         (int)options->dim);
    if (gpu_limits(how->gpu)->max_image_3d < (uint32_t)options->dim)
        return host_fail(how->host, FAIL_UNSUPPORTED,
                         "gi lpv: dim=%d: the device has 3D images of at most %u",
                         (int)options->dim, gpu_limits(how->gpu)->max_image_3d);
    return true;
}

static bool create_volume(struct lpv *lpv, struct lpv_volume *volume,
                          const char *const names[LPV_COLOURS], enum gpu_format format)
{
    const uint32_t dim = (uint32_t)lpv->options.dim;
    for (int i = 0; i < LPV_COLOURS; i++) {
        const struct gpu_image_desc desc = { .name = names[i],
                                             .dimension = GPU_3D,
                                             .format = format,
                                             .width = dim,
                                             .height = dim,
                                             .depth = dim,
                                             .usage = GPU_SAMPLED | GPU_STORAGE };
        if (!gpu_image_create(lpv->gpu, &desc, &volume->colour[i])) return false;
    }
    return true;
}

#define COLOUR_NAMES(thing)                                                                        \
    ((const char *const[]){ "lpv." thing "_red", "lpv." thing "_green", "lpv." thing "_blue" })

static bool create_resources(struct lpv *lpv)
{
    const size_t dim = (size_t)lpv->options.dim;
    const struct gpu_buffer_desc sums = { .name = "lpv.sums",
                                          .bytes = dim * dim * dim * LPV_CELL_BYTES,
                                          .usage = GPU_BUFFER_STORAGE };
    const struct gpu_sampler_desc linear = { .name = "lpv.linear",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return gpu_sampler_get(lpv->gpu, &linear, &lpv->linear) &&
           gpu_buffer_create(lpv->gpu, &sums, &lpv->sums) &&
           create_volume(lpv, &lpv->injected, COLOUR_NAMES("injected"), GPU_RGBA32F) &&
           create_volume(lpv, &lpv->steps[0], COLOUR_NAMES("step_even"), GPU_RGBA32F) &&
           create_volume(lpv, &lpv->steps[1], COLOUR_NAMES("step_odd"), GPU_RGBA32F) &&
           create_volume(lpv, &lpv->light, COLOUR_NAMES("light"), GPU_RGBA16F);
}

static bool create_pipelines(struct lpv *lpv)
{
    const struct {
        gpu_pipeline *out;
        const char *name;
        const struct gpu_shader *shader;
    } pipelines[] = {
        { &lpv->inject, "lpv.inject", &shader_lpv_inject_comp },
        { &lpv->inject_emitters, "lpv.inject_emitters", &shader_lpv_inject_emitters_comp },
        { &lpv->resolve, "lpv.resolve", &shader_lpv_resolve_comp },
        { &lpv->propagate, "lpv.propagate", &shader_lpv_propagate_comp },
        { &lpv->finish, "lpv.finish", &shader_lpv_finish_comp },
        { &lpv->apply, "lpv.apply", &shader_lpv_apply_comp },
        { &lpv->debug, "lpv.debug", &shader_lpv_debug_comp },
    };
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        if (!gpu_compute_pipeline_create(lpv->gpu, pipelines[i].name, pipelines[i].shader, NULL, 0,
                                         pipelines[i].out))
            return false;
    return true;
}

static bool lpv_create(void *state, const struct technique_create *how)
{
    struct lpv *lpv = state;
    lpv->gpu = how->gpu;
    lpv->options = *(const struct lpv_options *)how->options;
    return create_resources(lpv) && create_pipelines(lpv);
}

static void lpv_set_options(void *state, const void *options)
{
    struct lpv *lpv = state;
    const int32_t dim = lpv->options.dim; // what the images have
    lpv->options = *(const struct lpv_options *)options;
    lpv->options.dim = dim;
}

static void lpv_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv *lpv = state;
    if (!lpv_prepare(lpv, view)) {
        gpu_clear_image(cmd, view->layers[FRAME_IRRADIANCE],
                        (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    lpv_record_injection(lpv, cmd, view);
    lpv_record_propagation(lpv, cmd);
    lpv_record_application(lpv, cmd, view);
}

static void lpv_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    struct lpv *lpv = state;
    if (!lpv->lit) {
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    lpv_record_debug(lpv, cmd, view,
                     strcmp(name, "cells") == 0        ? LPV_VIEW_CELLS
                     : strcmp(name, "propagated") == 0 ? LPV_VIEW_PROPAGATED
                                                       : LPV_VIEW_INJECTED,
                     out);
}

static void destroy_volume(struct lpv *lpv, struct lpv_volume *volume)
{
    for (int i = 0; i < LPV_COLOURS; i++) gpu_image_destroy(lpv->gpu, &volume->colour[i]);
}

static void lpv_destroy(void *state)
{
    struct lpv *lpv = state;
    if (!lpv->gpu) return;
    destroy_volume(lpv, &lpv->injected);
    destroy_volume(lpv, &lpv->steps[0]);
    destroy_volume(lpv, &lpv->steps[1]);
    destroy_volume(lpv, &lpv->light);
    gpu_buffer_destroy(lpv->gpu, &lpv->sums);
    gpu_pipeline *pipelines[] = { &lpv->inject,    &lpv->inject_emitters, &lpv->resolve,
                                  &lpv->propagate, &lpv->finish,          &lpv->apply,
                                  &lpv->debug };
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        gpu_pipeline_destroy(lpv->gpu, pipelines[i]);
}

static uint64_t lpv_memory_estimate(const void *options, uint32_t width, uint32_t height)
{
    (void)width;
    (void)height;
    const uint64_t dim = (uint64_t)((const struct lpv_options *)options)->dim;
    const uint64_t cell =
        LPV_CELL_BYTES + LPV_COLOURS * (3 * (uint64_t)gpu_format_bytes(GPU_RGBA32F) +
                                        (uint64_t)gpu_format_bytes(GPU_RGBA16F));
    return dim * dim * dim * cell;
}

const struct technique technique_lpv = {
    .name = "lpv",
    .title = "light propagation volumes",
    .paper =
        "Martin 2012, Higher Order Light Propagation Volumes, ch. 3; Kaplanyan & Dachsbacher 2010",
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_NEEDS_RSM | FRAME_NEEDS_EMITTERS | FRAME_WRITES_IRRADIANCE,
    .options = { option_rows, sizeof option_rows / sizeof option_rows[0],
                 sizeof(struct lpv_options) },
    .debug_views = debug_views,
    .state_size = sizeof(struct lpv),
    .check = lpv_check,
    .create = lpv_create,
    .set_options = lpv_set_options,
    .record = lpv_record,
    .debug_view = lpv_debug_view,
    .destroy = lpv_destroy,
    .memory_estimate = lpv_memory_estimate,
};
