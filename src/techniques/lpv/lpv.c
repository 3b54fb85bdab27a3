// Light propagation volumes (Martin 2012, ch. 3; Kaplanyan & Dachsbacher 2010) and those of higher
// order (Martin 2012, ch. 4): one method, two sets of defaults.
//
// Virtual lights of the reflective shadow maps and of emissive surfaces are injected into a grid as
// spherical harmonics (inject), their light propagates from cell to cell past occluders (geometry,
// propagate), and each pixel samples its irradiance, from which its specular lobe reflects a share
// (apply). Lights and geometry may move.
#include "techniques/lpv/lpv.h"

#include "techniques/lpv/debug/debug.h"
#include "techniques/lpv/lpv_diagnostics.h"
#include "techniques/lpv/lpv_pipelines.h"
#include "techniques/lpv/lpv_prepare.h"
#include "techniques/lpv/lpv_state.h"
#include "techniques/lpv/lpv_volumes.h"

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

static const struct option_alias aliases[] = { { "blocking", "occlusion" }, { NULL, NULL } };

static const struct technique_debug_view debug_views[] = {
    { "injected", "slices of the grid: injected light, of lit and emissive surfaces", NULL },
    { "propagated", "slices of the grid: light accumulated over all steps", NULL },
    { "cells", "surfaces coloured by the cell that they inject into, bright if injected", NULL },
    { "geometry", "slices of the grid: light occluded along x, y, z, as red, green, blue", NULL },
    { PROBES_VIEW, PROBES_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

// Chosen by error and time: docs/notes/lpv.md. Costlier options do not have less error than the
// defaults, so that there is no preset "high".
static const struct technique_preset presets[] = {
    { "low", "dim=16,steps=5,bounces=2" },
    { "medium", "" },
    { NULL, NULL },
};
static const struct technique_preset higher_order_presets[] = {
    { "low", "dim=16,cascades=2,steps=6" },
    { "medium", "" },
    { NULL, NULL },
};

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

static void lpv_objects(const void *options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    (void)view, (void)width, (void)height;
    lpv_add_volumes(options, out);
    lpv_add_pipelines(options, out);
}

static bool create(struct lpv *lpv, const char *owner, const struct technique_create *how)
{
    const struct lpv_options *options = how->options;
    if (how->pose) lpv_diagnose(how->host, owner, options, how->pose);
    lpv->gpu = how->gpu;
    for (int i = 1; i < options->cascades; i++) lpv->cascades[i - 1].coarser = &lpv->cascades[i];
    lpv_probes_create(&lpv->probes, options);
    return true;
}

static bool lpv_create(void *state, const struct technique_create *how)
{
    return create(state, "lpv", how);
}

static bool holpv_create(void *state, const struct technique_create *how)
{
    return create(state, "holpv", how);
}

static void lpv_invalidate(void *state, uint32_t changes)
{
    struct lpv *lpv = state;
    const bool statics = changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL);
    for (struct lpv_cascade *c = lpv->cascades; c; c = c->coarser) {
        c->kept.known = false;
        c->geometry.statics.valid &= !statics;
        c->surfaces.statics.valid &= !statics;
    }
}

static struct lpv_frame frame_of(const struct lpv *lpv, struct gpu_cmd *cmd,
                                 const struct frame_view *view)
{
    return (struct lpv_frame){ .options = &lpv->options,
                               .gpu = lpv->gpu,
                               .cmd = cmd,
                               .view = view,
                               .injection = &lpv->injection,
                               .linear = lpv->linear };
}

// The coarser cascades first. Returns false where the light is that of the frame before.
static bool record_light(const struct lpv *lpv, const struct lpv_frame *frame,
                         struct lpv_cascade *cascade)
{
    const bool changed = cascade->coarser && record_light(lpv, frame, cascade->coarser);
    if (lpv_is_kept(cascade, frame->options, frame->view) && !changed) return false;
    lpv_record_geometry(&lpv->geometry, frame, cascade);
    lpv_record_injection(&lpv->injection, frame, cascade);
    lpv_record_surfaces(&lpv->surfaces, frame, cascade);
    lpv_record_propagation(&lpv->propagation, frame, cascade);
    return true;
}

static void lpv_update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv *lpv = state;
    struct lpv_cascade *finest = &lpv->cascades[0];
    const struct lpv_frame frame = frame_of(lpv, cmd, view);
    lpv->lit = lpv_prepare(&lpv->options, finest, view);
    if (lpv->lit) record_light(lpv, &frame, finest);
    lpv_record_probes(&lpv->probes, &frame, lpv->lit ? finest : NULL);
}

static void clear_layers(const struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const float black[4] = { 0.0f, 0.0f, 0.0f, 1.0f };
    gpu_clear_image(cmd, view->layers[FRAME_IRRADIANCE], black);
    if (lpv->options.specular) gpu_clear_image(cmd, view->layers[FRAME_SPECULAR], black);
}

static void lpv_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct lpv *lpv = state;
    const struct lpv_frame frame = frame_of(lpv, cmd, view);
    if (lpv->lit)
        lpv_record_application(&lpv->application, &frame, &lpv->cascades[0]);
    else
        clear_layers(lpv, cmd, view);
}

static void lpv_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    struct lpv *lpv = state;
    const struct lpv_frame frame = frame_of(lpv, cmd, view);
    if (!lpv->lit) {
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    lpv_record_debug(lpv->debug, &frame, &lpv->cascades[0],
                     strcmp(name, "cells") == 0        ? LPV_VIEW_CELLS
                     : strcmp(name, "geometry") == 0   ? LPV_VIEW_GEOMETRY
                     : strcmp(name, "propagated") == 0 ? LPV_VIEW_PROPAGATED
                                                       : LPV_VIEW_INJECTED,
                     out);
}

static bool lpv_probes(void *state, struct probe_volume *out)
{
    const struct lpv *lpv = state;
    return lpv_probes_publish(&lpv->probes, &lpv->options, out);
}

static uint32_t lpv_more_needs(const void *options)
{
    const struct lpv_options *o = options;
    return (o->geometry == LPV_GEOMETRY_MAPS ? FRAME_UPDATE_NEEDS_GBUFFER : 0) |
           (o->specular ? FRAME_WRITES_SPECULAR : 0);
}

#define LPV_TECHNIQUE(name_, title_, paper_, rows_, presets_)                                      \
    .name = name_, .title = title_, .paper = paper_, .folder = "lpv", .role = ROLE_SOURCE,         \
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | PUBLISHES_PROBES | GATHERS_EMISSION,     \
    .needs = FRAME_NEEDS_RSM | FRAME_NEEDS_EMITTERS | FRAME_WRITES_IRRADIANCE,                     \
    .more_needs = lpv_more_needs, .options = OPTION_TABLE(struct lpv_options, rows_, aliases),     \
    .presets = presets_, .debug_views = debug_views, .state_size = sizeof(struct lpv),             \
    .invalidate = lpv_invalidate, .update = lpv_update, .record = lpv_record,                      \
    .debug_view = lpv_debug_view, .probes = lpv_probes, .objects = lpv_objects

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
