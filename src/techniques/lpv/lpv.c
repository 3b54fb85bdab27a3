// Light propagation volumes (Martin 2012, ch. 3; Kaplanyan & Dachsbacher 2010) and those of higher
// order (Martin 2012, ch. 4). One method with other defaults.
//
// The light that reflective shadow maps see leaving the lit surfaces, and that of emissive
// surfaces, is put into a grid over the scene as spherical harmonics (inject), walks from cell to
// neighbour past what stands in its way (geometry, propagate), and is looked up by each pixel
// (apply). Diffuse, everything moving. README.md says what differs from the paper and
// how good it is.
#include "techniques/lpv/lpv.h"

#include "techniques/lpv/lpv_remarks.h"
#include "techniques/lpv/lpv_state.h"

#include "technique_shaders.h"

#include <string.h>

#define OPTION(...) OPTION_ROW(struct lpv_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#define LPV_DEFAULT(of_lpv, of_holpv) (of_lpv)
#include "techniques/lpv/lpv_options.def"
#undef LPV_DEFAULT
};
static const struct option_row higher_order_rows[] = {
#define LPV_DEFAULT(of_lpv, of_holpv) (of_holpv)
#include "techniques/lpv/lpv_options.def"
#undef LPV_DEFAULT
};
#undef OPTION

#define NAMES(technique)                                                                           \
    {                                                                                              \
        .gi = technique, .inject = technique ".inject",                                            \
        .inject_emitters = technique ".inject_emitters", .resolve = technique ".resolve",          \
        .geometry = technique ".geometry", .refine = technique ".refine",                          \
        .propagate = technique ".propagate", .apply = technique ".apply",                          \
        .probes = technique ".probes", .surfaces = technique ".surfaces",                          \
        .reflected = technique ".reflected", .sent = technique ".sent",                            \
        .debug = technique ".debug", .sums = technique ".sums", .injected = technique ".injected", \
        .light = technique ".light", .coarser_light = technique ".coarser_light",                  \
        .steps = { technique ".step_even", technique ".step_odd" }, .linear = technique ".linear", \
        .of_geometry = LPV_GEOMETRY_NAMES(technique),                                              \
    }
static const struct lpv_names names = NAMES("lpv"), higher_order_names = NAMES("holpv");

static const struct technique_debug_view debug_views[] = {
    { "injected", "slices of the grid: the light that lit and emissive surfaces put in", NULL },
    { "propagated", "slices of the grid: the light accumulated over all steps", NULL },
    { "cells",
      "the surfaces coloured by the cell they inject into, bright where light was injected", NULL },
    { "geometry",
      "slices of the grid: what is held back along x, y, z at each cell's low faces, "
      "as red, green, "
      "blue",
      NULL },
    { PROBES_VIEW, PROBES_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

// Chosen by measured error and time, see README.md.
static const struct technique_preset presets[] = { { "low", "dim=16,steps=5,bounces=2" },
                                                   { "medium", "" },
                                                   { "high", "dim=48,steps=12" },
                                                   { NULL, NULL } };
static const struct technique_preset higher_order_presets[] = { { "low",
                                                                  "dim=16,cascades=2,steps=6" },
                                                                { "medium", "" },
                                                                { "high", "dim=48,steps=8" },
                                                                { NULL, NULL } };

static bool check(const char *name, const struct technique_create *how)
{
    const struct lpv_options *options = how->options;
    const uint32_t depth = (uint32_t)options->dim * lpv_slabs(options);
    if (options->dim % 8 != 0)
        return host_fail(how->host, FAIL_ARGUMENT, "gi %s: dim=%d is not a multiple of 8", name,
                         (int)options->dim);
    if (gpu_limits(how->gpu)->max_image_3d < depth)
        return host_fail(how->host, FAIL_UNSUPPORTED,
                         "gi %s: dim=%d needs 3D images of a depth of %u, the device has %u", name,
                         (int)options->dim, depth, gpu_limits(how->gpu)->max_image_3d);
    return true;
}

static bool lpv_check(const struct technique_create *how)
{
    return check("lpv", how);
}

static bool holpv_check(const struct technique_create *how)
{
    return check("holpv", how);
}

bool lpv_create_volume(struct lpv *lpv, const char *name, enum gpu_format format, gpu_image *out)
{
    const uint32_t dim = (uint32_t)lpv->options.dim;
    const struct gpu_image_desc desc = { .name = name,
                                         .dimension = GPU_3D,
                                         .format = format,
                                         .width = dim,
                                         .height = dim,
                                         .depth = dim * lpv_slabs(&lpv->options),
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    return gpu_image_create(lpv->gpu, &desc, out);
}

static bool create_volumes(struct lpv *lpv)
{
    const struct lpv_names *name = lpv->names;
    const bool half = lpv->options.precision == LPV_PRECISION_HALF;
    const enum gpu_format format = half ? GPU_RGBA16F : GPU_RGBA32F;
    return lpv_create_volume(lpv, name->injected, format, &lpv->injected) &&
           lpv_create_volume(lpv, name->steps[0], format, &lpv->steps[0]) &&
           (half || lpv_create_volume(lpv, name->steps[1], format, &lpv->steps[1])) &&
           lpv_create_volume(lpv, name->light, GPU_RGBA16F, &lpv->light);
}

static bool create_resources(struct lpv *lpv)
{
    const size_t dim = (size_t)lpv->options.dim;
    const struct gpu_buffer_desc sums = { .name = lpv->names->sums,
                                          .bytes = dim * dim * dim * lpv_cell_bytes(&lpv->options),
                                          .usage = GPU_BUFFER_STORAGE };
    const struct gpu_sampler_desc linear = { .name = lpv->names->linear,
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return gpu_sampler_get(lpv->gpu, &linear, &lpv->linear) &&
           gpu_buffer_create(lpv->gpu, &sums, &lpv->sums) && create_volumes(lpv);
}

static bool create_application(struct lpv *lpv)
{
    const struct gpu_constant constants[] = {
        { LPV_CONSTANT_BANDS, (uint32_t)lpv->options.bands },
        { LPV_CONSTANT_HALF, lpv->options.precision == LPV_PRECISION_HALF },
        { LPV_CONSTANT_CUBIC, lpv->options.reconstruction == LPV_CUBIC },
        { LPV_CONSTANT_DAMPED, 1 },
    };
    return gpu_compute_pipeline_create(lpv->gpu, lpv->names->apply, &shader_lpv_apply_comp,
                                       constants, 3, &lpv->apply) &&
           gpu_compute_pipeline_create(lpv->gpu, lpv->names->apply, &shader_lpv_apply_comp,
                                       constants, 4, &lpv->apply_damped);
}

static bool create_pipelines(struct lpv *lpv)
{
    const struct lpv_names *name = lpv->names;
    const struct {
        gpu_pipeline *out;
        const char *name;
        const struct gpu_shader *shader;
        int constants; // how many of them it has
    } pipelines[] = {
        { &lpv->inject, name->inject, &shader_lpv_inject_comp, 2 },
        { &lpv->inject_emitters, name->inject_emitters, &shader_lpv_inject_emitters_comp, 2 },
        { &lpv->resolve, name->resolve, &shader_lpv_resolve_comp, 2 },
        { &lpv->propagate, name->propagate, &shader_lpv_propagate_comp, 4 },
        { &lpv->debug, name->debug, &shader_lpv_debug_comp, 3 },
    };
    const struct gpu_constant constants[] = {
        { LPV_CONSTANT_BANDS, (uint32_t)lpv->options.bands },
        { LPV_CONSTANT_HALF, lpv->options.precision == LPV_PRECISION_HALF },
        { LPV_CONSTANT_GEOMETRY, (uint32_t)lpv->options.geometry },
        { LPV_CONSTANT_NEIGHBOURS, lpv->options.neighbours == LPV_SIX ? 6 : 26 },
        { LPV_CONSTANT_HELD, 1 },
    };
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        if (!gpu_compute_pipeline_create(lpv->gpu, pipelines[i].name, pipelines[i].shader,
                                         constants, pipelines[i].constants, pipelines[i].out))
            return false;
    if (!create_application(lpv)) return false;
    return lpv->options.geometry == LPV_GEOMETRY_OFF ||
           gpu_compute_pipeline_create(lpv->gpu, name->propagate, &shader_lpv_propagate_comp,
                                       constants, 5, &lpv->propagate_held);
}

static bool create(struct lpv_cascades *cascades, const struct lpv_names *name,
                   const struct technique_create *how)
{
    struct lpv *lpv = &cascades->levels[0];
    lpv->names = name;
    if (how->pose) lpv_remark_on_scene(how->host, name->gi, how->options, how->pose);
    lpv->gpu = how->gpu;
    lpv->options = *(const struct lpv_options *)how->options;
    return create_resources(lpv) && create_pipelines(lpv) && lpv_geometry_create(lpv) &&
           lpv_probes_create(lpv) && lpv_bounce_create(lpv) && lpv_cascades_create(cascades);
}

static bool lpv_create(void *state, const struct technique_create *how)
{
    return create(state, &names, how);
}

static bool holpv_create(void *state, const struct technique_create *how)
{
    return create(state, &higher_order_names, how);
}

static void lpv_set_options(void *state, const void *options)
{
    struct lpv *lpv = state;
    // What the images and the shaders were made for stays.
    struct lpv_options next = *(const struct lpv_options *)options;
    next.bands = lpv->options.bands;
    next.cascades = lpv->options.cascades;
    next.neighbours = lpv->options.neighbours;
    next.precision = lpv->options.precision;
    next.dim = lpv->options.dim;
    next.reconstruction = lpv->options.reconstruction;
    next.geometry = lpv->options.geometry;
    next.probes = lpv->options.probes;
    next.bounces = lpv->options.bounces;
    lpv->options = next;
}

static void lpv_invalidate(void *state, uint32_t changes)
{
    if (!(changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL))) return;
    for (struct lpv *level = state; level; level = level->coarser) {
        lpv_geometry_forget(level);
        level->bounce.kept = false;
    }
}

// The coarser cascades first.
static void record_light(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    if (lpv->coarser) record_light(lpv->coarser, cmd, view);
    lpv_record_injection(lpv, cmd, view);
    lpv_record_geometry(lpv, cmd, view);
    lpv_record_surfaces(lpv, cmd, view);
    lpv_record_propagation(lpv, cmd);
}

static void lpv_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv *lpv = state;
    if (!lpv_prepare(lpv, view)) {
        gpu_clear_image(cmd, view->layers[FRAME_IRRADIANCE],
                        (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        lpv_record_probes(lpv, cmd);
        return;
    }
    record_light(lpv, cmd, view);
    lpv_record_application(lpv, cmd, view);
    lpv_record_probes(lpv, cmd);
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
                     : strcmp(name, "geometry") == 0   ? LPV_VIEW_GEOMETRY
                     : strcmp(name, "propagated") == 0 ? LPV_VIEW_PROPAGATED
                                                       : LPV_VIEW_INJECTED,
                     out);
}

static bool lpv_probes(void *state, struct probe_volume *out)
{
    return lpv_probes_publish(state, out);
}

static void lpv_destroy(void *state)
{
    struct lpv *lpv = state;
    if (!lpv->gpu) return;
    lpv_cascades_destroy(state);
    gpu_image *images[] = { &lpv->injected, &lpv->steps[0], &lpv->steps[1], &lpv->light };
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        gpu_image_destroy(lpv->gpu, images[i]);
    gpu_buffer_destroy(lpv->gpu, &lpv->sums);
    lpv_probes_destroy(lpv);
    lpv_bounce_destroy(lpv);
    gpu_pipeline *pipelines[] = { &lpv->inject,         &lpv->inject_emitters,
                                  &lpv->resolve,        &lpv->propagate,
                                  &lpv->propagate_held, &lpv->apply,
                                  &lpv->apply_damped,   &lpv->debug };
    for (size_t i = 0; i < sizeof pipelines / sizeof pipelines[0]; i++)
        gpu_pipeline_destroy(lpv->gpu, pipelines[i]);
    lpv_geometry_destroy(lpv);
}

static uint64_t lpv_memory_estimate(const void *options, uint32_t width, uint32_t height)
{
    (void)width;
    (void)height;
    const struct lpv_options *how = options;
    const uint64_t dim = (uint64_t)how->dim, half = (uint64_t)gpu_format_bytes(GPU_RGBA16F),
                   full = (uint64_t)gpu_format_bytes(GPU_RGBA32F);
    const uint64_t slab = how->precision == LPV_PRECISION_HALF ? 3 * half : 3 * full + half;
    const uint64_t lights = (uint64_t)(how->cascades - 1) * half; // of the coarser cascades
    return dim * dim * dim * (lpv_cell_bytes(how) + (slab + lights) * lpv_slabs(how)) +
           (uint64_t)how->cascades * lpv_geometry_bytes(how) + lpv_probes_bytes(how) +
           lpv_bounce_bytes(how);
}

#define LPV_TECHNIQUE(name_, title_, paper_, rows_, presets_)                                      \
    .name = name_, .title = title_, .paper = paper_, .folder = "lpv", .role = ROLE_SOURCE,         \
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | PUBLISHES_PROBES | GATHERS_EMISSION,     \
    .needs = FRAME_NEEDS_RSM | FRAME_NEEDS_EMITTERS | FRAME_WRITES_IRRADIANCE,                     \
    .options = OPTION_TABLE(struct lpv_options, rows_, NULL), .presets = presets_,                 \
    .debug_views = debug_views, .state_size = sizeof(struct lpv_cascades),                         \
    .set_options = lpv_set_options, .invalidate = lpv_invalidate, .record = lpv_record,            \
    .debug_view = lpv_debug_view, .probes = lpv_probes, .destroy = lpv_destroy,                    \
    .memory_estimate = lpv_memory_estimate

const struct technique technique_lpv = {
    LPV_TECHNIQUE("lpv", "light propagation volumes",
                  "Martin 2012, Higher Order Light Propagation Volumes, ch. 3; Kaplanyan & "
                  "Dachsbacher 2010",
                  option_rows, presets),
    .check = lpv_check,
    .create = lpv_create,
};

const struct technique technique_holpv = {
    LPV_TECHNIQUE("holpv", "higher order light propagation volumes",
                  "Martin 2012, Higher Order Light Propagation Volumes, ch. 4", higher_order_rows,
                  higher_order_presets),
    .check = holpv_check,
    .create = holpv_create,
};
