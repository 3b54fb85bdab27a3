// Voxel cone tracing with interleaved sampling (Hong 2015, ch. 2.5.3 and 4; Crassin et al. 2011).
//
// The scene is voxelized (voxelize/), the voxels are lit (lighting/) and prefiltered into mips of a
// light volume (volume/) or into an octree (octree/). Each pixel traces some of the cones of its
// hemisphere and gathers the others from its neighbours (cones/). README.md says what differs from
// the paper.
//
// vctao traces the same cones through opacity alone: ambient occlusion (sec. 2.5.3.3.8).
#include "techniques/vct/vct.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_debug.h"
#include "techniques/vct/vct_pipelines.h"
#include "techniques/vct/vct_resources.h"
#include "techniques/vct/vct_state.h"

#include "frame/scene/scene_gpu.h"

#include <string.h>

#define OPTION(...) OPTION_ROW(struct vct_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#define VCT_OPTION OPTION
#define VCTAO_OPTION(...)
#define VCT_DEFAULT(of_vct, of_vctao) (of_vct)
#include "techniques/vct/vct_options.def"
#undef VCT_DEFAULT
#undef VCTAO_OPTION
#undef VCT_OPTION
};
static const struct option_row occlusion_rows[] = {
#define VCT_OPTION(...)
#define VCTAO_OPTION                  OPTION
#define VCT_DEFAULT(of_vct, of_vctao) (of_vctao)
#include "techniques/vct/vct_options.def"
#undef VCT_DEFAULT
#undef VCTAO_OPTION
#undef VCT_OPTION
};
#undef OPTION

static const struct option_alias aliases[] = {
    { "half", "half_resolution" },
    { "stride", "step_size" },
    { "lamps", "small_emitters" },
    { NULL, NULL },
};
static const struct option_alias occlusion_aliases[] = {
    { "half", "half_resolution" },
    { "stride", "step_size" },
    { NULL, NULL },
};

// Chosen by measured error and time: bench/results/vct.md.
static const struct technique_preset presets[] = {
    { "low", "resolution=32,half_resolution=true" },
    { "medium", "" },
    { "high", "resolution=128,interleave=3,half_resolution=true,specular=true,wide_filter=64" },
    { NULL, NULL },
};
static const struct technique_preset occlusion_presets[] = {
    { "low", "resolution=32" },
    { "medium", "" },
    { "high", "resolution=128,temporal=true" },
    { NULL, NULL },
};

#define LEVELS_HELP "visible voxels by level of the clip map, red is the finest"
static const struct technique_debug_view debug_views[] = {
    { "reflectance", "visible voxels: diffuse reflectance", NULL },
    { "normals", "visible voxels: normal of the front", NULL },
    { "radiance", "visible voxels: radiance towards the camera", NULL },
    { "levels", LEVELS_HELP, NULL },
    { "overflow", "visible voxels: red where the capacity is exceeded and light is missing",
      "room" },
    { NULL, NULL, NULL },
};
static const struct technique_debug_view occlusion_views[] = {
    { "normals", "visible voxels: normal of the front", NULL },
    { "levels", LEVELS_HELP, NULL },
    { "overflow", "visible voxels: red where the capacity is exceeded and occlusion is missing",
      "room" },
    { NULL, NULL, NULL },
};

static bool vct_check(const struct technique_create *how)
{
    const struct vct_options options = vct_light_options(how->options);
    return vct_check_options("vct", how, &options);
}

static bool vctao_check(const struct technique_create *how)
{
    const struct vct_options options = vct_occlusion_options(how->options);
    return vct_check_options("vctao", how, &options);
}

// ---- Creation and changes -----------------------------------------------------------------------

static void add_objects(struct vct_options options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    vct_add_volumes(&options, out);
    vct_add_pixels(&options, view, width, height, out);
    vct_add_pipelines(&options, out);
}

static void vct_objects(const void *options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    add_objects(vct_light_options(options), view, width, height, out);
}

static void vctao_objects(const void *options, int view, uint32_t width, uint32_t height,
                          struct gpu_objects *out)
{
    add_objects(vct_occlusion_options(options), view, width, height, out);
}

static bool vct_resize(void *state, int view, uint32_t width, uint32_t height)
{
    struct vct *vct = state;
    struct vct_view *v = &vct->views[view];
    v->pixels.width = gpu_groups(width, vct_step(&vct->options));
    v->pixels.height = gpu_groups(height, vct_step(&vct->options));
    v->temporal.unlit = vct->options.occlusion;
    vct_temporal_invalidate(&v->temporal);
    return true;
}

static void forget_histories(struct vct *vct)
{
    for (int i = 0; i < FRAME_MAX_VIEWS; i++) vct_temporal_invalidate(&vct->views[i].temporal);
}

static bool create(struct vct *vct, const char *name, const struct technique_create *how,
                   struct vct_options options)
{
    if (how->pose) vct_log_diagnostics(how->host, name, &options, how->pose);
    vct->options = options;
    vct->overflow.host = how->host;
    vct->overflow.gpu = how->gpu;
    vct->overflow.technique = name;
    vct->clipmap.count = vct_clip_count(&options);
    vct->svo.params = vct_svo_params(&options);
    vct_cone_axes(options.cones, vct->cones.axes);
    return vct_resize(vct, 0, how->width, how->height);
}

static bool vct_create(void *state, const struct technique_create *how)
{
    return create(state, "vct", how, vct_light_options(how->options));
}

static bool vctao_create(void *state, const struct technique_create *how)
{
    return create(state, "vctao", how, vct_occlusion_options(how->options));
}

static void invalidate_voxels(struct vct *vct)
{
    vct_voxels_invalidate(&vct->voxels);
    vct->small_emitters.chosen = false;
}

static void vct_set_options(void *state, const void *options)
{
    struct vct *vct = state;
    const struct vct_options *now = &vct->options;
    const struct vct_options next =
        now->occlusion ? vct_occlusion_options(options) : vct_light_options(options);
    const bool emitters = next.small_emitters != now->small_emitters;
    if (emitters) invalidate_voxels(vct);
    // Options of the light of voxels; those of the pixels' cones alone keep bounced light.
    if (emitters || next.bounces != now->bounces || next.offset != now->offset ||
        next.step_size != now->step_size)
        vct_lighting_invalidate(&vct->lighting);
    vct_cone_axes(next.cones, vct->cones.axes);
    forget_histories(vct);
}

static void vct_invalidate(void *state, uint32_t changes)
{
    struct vct *vct = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL)) invalidate_voxels(vct);
    if (changes & CHANGED_OPTIONS) vct_lighting_invalidate(&vct->lighting);
    vct->kept.lit = false;
    // The history follows lights and movable geometry.
    if (changes & ~(uint32_t)(CHANGED_LIGHT | CHANGED_MOVABLE)) forget_histories(vct);
}

// ---- Frames -------------------------------------------------------------------------------------

// The parameters of all passes but for the placement of a grid.
static struct vct_params params_of(const struct vct *vct, const struct frame_view *view)
{
    const float strongest = view->scene->max_emissive;
    return (struct vct_params){
        .dim = vct->options.resolution,
        .capacity = vct_capacity(&vct->options),
        .emission_fixed = strongest > 0.0f ? (float)VCT_EMISSION_ONE / strongest : 0.0f,
        .emission_scaled = strongest / (float)VCT_EMISSION_ONE * view->constants->radiance_scale,
        .shadow_size = (float)view->shadow_size,
        .shadow_radius = view->shadow_radius,
        .volume_dim = (int32_t)vct_volume_dim(&vct->options),
        .light_count = vct->options.occlusion ? 0 : view->constants->light_count,
        .light_scale = 1.0f,
        .decay_per_m = vct->options.decay,
        .offset = vct->options.offset,
    };
}

static struct vct_frame frame_of(struct vct *vct, struct gpu_cmd *cmd,
                                 const struct frame_view *view)
{
    return (struct vct_frame){ .options = &vct->options,
                               .cmd = cmd,
                               .view = view,
                               .voxels = &vct->voxels,
                               .rays = &vct->rays,
                               .svo = &vct->svo,
                               .emitters = &vct->small_emitters,
                               .clipmap = &vct->clipmap,
                               .volume = &vct->volume,
                               .params = vct->params };
}

// An empty grid: no light, everything visible.
static void clear(const struct vct_frame *frame)
{
    const float open = frame->options->occlusion ? 1.0f : 0.0f;
    gpu_clear_image(frame->cmd, vct_result(frame), (const float[4]){ open, open, open, 1.0f });
    if (frame->options->specular != VCT_SPECULAR_NONE)
        gpu_clear_image(frame->cmd, frame->view->layers[FRAME_SPECULAR],
                        (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
}

// The grids of this frame. False: the scene has no extent.
static bool place_grids(struct vct *vct, const struct frame_view *view)
{
    const uint32_t changes = vct_clipmap_update(&vct->clipmap, vct->options.resolution, view);
    if (changes & VCT_OTHER_DRAWS) vct->small_emitters.chosen = false;
    if (changes & VCT_OTHER_GRID) vct_lighting_invalidate(&vct->lighting);
    return !(changes & VCT_NO_EXTENT);
}

static void record_voxels(struct vct *vct, const struct vct_frame *frame)
{
    vct_voxelize(&vct->voxels, frame, vct->kept.still);
    for (int i = 0; i < vct->clipmap.count; i++) {
        if (!vct->voxels.levels[i].revoxelized) continue;
        vct_volume_list_texels(&vct->volume, frame, i);
        if (vct_has_rays(&vct->options)) vct_rays_list_blocks(&vct->rays, frame, i);
        if (!vct->options.occlusion) vct_list_parts(&vct->lighting, frame, i);
    }
    if (vct->voxels.revoxelized && vct_has_svo(&vct->options)) vct_octree_build(&vct->svo, frame);
    vct_watch_overflow(&vct->overflow, frame);
}

// Specular cones see small emitters in the light volume. Diffuse cones and the bounces of the next
// frame must not, as they sample them with shadow cones.
static void record_specular(const struct vct *vct, const struct vct_view *of,
                            const struct vct_frame *frame)
{
    const bool emitters = vct->small_emitters.count > 0;
    struct vct_frame lit = *frame;
    lit.params.has_small_emitters = emitters;
    if (emitters) vct_refill_volume(&lit);
    vct_record_specular(&vct->specular, &of->reflections,
                        vct->options.temporal ? &of->temporal : NULL, &lit);
    if (emitters) vct_refill_volume(frame);
}

static void place_small_emitters(struct vct *vct, const struct frame_view *view)
{
    vct->begun = view->number;
    if (vct->options.small_emitters)
        vct_small_emitters_update(&vct->small_emitters, view,
                                  vct->views[view->number].temporal.number);
    else
        vct->small_emitters.count = 0;
}

// The history of a view, and the points on small emitters that its frame samples.
static void begin_view(struct vct *vct, const struct frame_view *view)
{
    const struct vct_options *options = &vct->options;
    if (options->temporal)
        vct_temporal_begin(&vct->views[view->number].temporal, view, vct_block(options),
                           options->frames, options->clamp, vct->settles);
    place_small_emitters(vct, view);
}

static void vct_update(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct vct *vct = state;
    vct->ready = place_grids(vct, view);
    if (!vct->ready) return;
    vct->params = params_of(vct, view);
    vct->settles = vct->lighting.bounces_left > 0;
    kept_update(&vct->kept, view, view->light_hash);
    begin_view(vct, view);
    struct vct_frame frame = frame_of(vct, cmd, view);
    record_voxels(vct, &frame);
    const bool bounced = !vct->options.occlusion && vct_record_bounce(&vct->lighting, &frame);
    vct_record_light(&vct->lighting, &frame, bounced, vct->kept.same);
    vct->params = frame.params;
}

static void record_view(struct vct *vct, const struct vct_frame *frame)
{
    const struct vct_options *options = &vct->options;
    struct vct_view *of = &vct->views[frame->view->number];
    struct vct_temporal *temporal = options->temporal ? &of->temporal : NULL;
    const gpu_image result = vct_result(frame);
    vct_record_cones(&vct->cones, &of->pixels, temporal, frame);
    if (temporal) vct_temporal_record(temporal, &vct->history, frame->cmd, frame->view, result);
    if (vct_denoises(options))
        vct_temporal_denoise(temporal, &vct->history, frame->cmd, frame->view,
                             vct_clipmap_longest_side_m(&vct->clipmap), options->wide_filter,
                             result);
    if (options->specular == VCT_SPECULAR_TRACED) record_specular(vct, of, frame);
    if (options->specular == VCT_SPECULAR_METALS) vct_record_metals(&vct->specular, frame);
}

static void vct_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct vct *vct = state;
    const struct vct_frame frame = frame_of(vct, cmd, view);
    if (!vct->ready) {
        clear(&frame);
        vct_temporal_invalidate(&vct->views[view->number].temporal);
        return;
    }
    // The update has begun the first view; after further ones its points are placed again.
    if (view->number > 0)
        begin_view(vct, view);
    else if (vct->begun != view->number)
        place_small_emitters(vct, view);
    record_view(vct, &frame);
}

static void vct_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    struct vct *vct = state;
    if (!vct->ready) {
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    const struct vct_frame frame = frame_of(vct, cmd, view);
    vct_record_debug(vct->debug, &frame,
                     strcmp(name, "normals") == 0    ? VCT_VIEW_NORMAL
                     : strcmp(name, "radiance") == 0 ? VCT_VIEW_RADIANCE
                     : strcmp(name, "overflow") == 0 ? VCT_VIEW_OVERFLOW
                     : strcmp(name, "levels") == 0   ? VCT_VIEW_LEVELS
                                                     : VCT_VIEW_REFLECTANCE,
                     out);
}

static void vct_destroy(void *state)
{
    struct vct *vct = state;
    if (vct->overflow.gpu) vct_report_overflow(&vct->overflow, &vct->options, &vct->clipmap);
}

static uint32_t vct_more_needs(const void *options)
{
    const struct vct_options *o = options;
    const bool specular = o->specular != VCT_SPECULAR_NONE;
    return (o->temporal ? FRAME_NEEDS_MOTION : 0) | (specular ? FRAME_WRITES_SPECULAR : 0) |
           (o->occlusion ? 0 : FRAME_NEEDS_EMITTERS);
}

static uint32_t vctao_more_needs(const void *options)
{
    const struct vct_options occlusion = vct_occlusion_options(options);
    return vct_more_needs(&occlusion);
}

// Members that vct and vctao have in common.
#define VCT_TECHNIQUE(of_name, of_title, of_paper)                                                 \
    .name = of_name, .title = of_title, .paper = of_paper, .state_size = sizeof(struct vct),       \
    .resize = vct_resize, .set_options = vct_set_options, .invalidate = vct_invalidate,            \
    .update = vct_update, .record = vct_record, .debug_view = vct_debug_view,                      \
    .destroy = vct_destroy

const struct technique technique_vct = {
    VCT_TECHNIQUE("vct", "voxel cone tracing",
                  "Hong 2015, Temporal Voxel Cone Tracing with Interleaved Sample Patterns, ch. "
                  "2.5.3, 4; Crassin et al. 2011"),
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | MAKES_SPECULAR | GATHERS_EMISSION,
    .needs = FRAME_WRITES_IRRADIANCE | FRAME_LIGHT_EVOLVES,
    .options = OPTION_TABLE(struct vct_options, option_rows, aliases),
    .presets = presets,
    .debug_views = debug_views,
    .more_needs = vct_more_needs,
    .check = vct_check,
    .fit = vct_fit_options,
    .objects = vct_objects,
    .create = vct_create,
};

const struct technique technique_vctao = {
    VCT_TECHNIQUE("vctao", "ambient occlusion by voxel cones",
                  "Hong 2015, Temporal Voxel Cone Tracing with Interleaved Sample Patterns, sec. "
                  "2.5.3.3.8; Crassin et al. 2011"),
    .folder = "vct",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .options = OPTION_TABLE(struct vct_options, occlusion_rows, occlusion_aliases),
    .presets = occlusion_presets,
    .debug_views = occlusion_views,
    .more_needs = vctao_more_needs,
    .check = vctao_check,
    .fit = vct_fit_options,
    .objects = vctao_objects,
    .create = vctao_create,
};
