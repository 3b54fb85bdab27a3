// Voxel cone tracing with interleaved sampling (Hong 2015, ch. 2.5.3 and 4; Crassin et al. 2011).
//
// The scene is turned into voxels that know what surfaces in them are like (voxelise), light is put
// on them (inject) and filtered into a pyramid of coarser ones (fill, filter); pixels gather it
// along cones, each a few of them, and share what they found with their neighbours (cones, gather).
// README.md says what differs from the paper and how good it is.
//
// vctao looks along the same cones for what is in the way alone: ambient occlusion
// (sec. 2.5.3.3.8).
#include "techniques/vct/vct.h"

#include "techniques/vct/vct_diagnostics.h"
#include "techniques/vct/vct_state.h"

#include <string.h>

#define OPTION(...) OPTION_ROW(struct vct_options, __VA_ARGS__)
static const struct option_row option_rows[] = {
#define VCT_OPTION OPTION
#define VCTAO_OPTION(...)
#include "techniques/vct/vct_options.def"
#undef VCTAO_OPTION
#undef VCT_OPTION
};
static const struct option_row occlusion_rows[] = {
#define VCT_OPTION(...)
#define VCTAO_OPTION OPTION
#include "techniques/vct/vct_options.def"
#undef VCTAO_OPTION
#undef VCT_OPTION
};
#undef OPTION

static const struct technique_debug_view debug_views[] = {
    { "reflectance", "the voxels that the eye sees, by what they reflect", NULL },
    { "normals", "the voxels that the eye sees, by the way of their front", NULL },
    { "radiance", "the voxels that the eye sees, by the light that they send to it", NULL },
    { "levels", "the voxels that the eye sees, by the grid that they are of: the finest one red",
      NULL },
    { "room", "the voxels that the eye sees, red where there was no room for their light", NULL },
    { NULL, NULL, NULL },
};

static const struct technique_debug_view occlusion_views[] = {
    { "normals", "the voxels that the eye sees, by the way of their front", NULL },
    { "levels", "the voxels that the eye sees, by the grid that they are of: the finest one red",
      NULL },
    { "room", "the voxels that the eye sees, red where there was no room for what they cover",
      NULL },
    { NULL, NULL, NULL },
};

// Chosen by measured error and time, see README.md.
static const struct technique_preset presets[] = {
    { "low", "resolution=32,half=true" },
    { "medium", "" },
    { "high", "resolution=128,temporal=true,specular=true" },
    { NULL, NULL },
};
static const struct technique_preset occlusion_presets[] = {
    { "low", "resolution=32" },
    { "medium", "" },
    { "high", "resolution=128,temporal=true" },
    { NULL, NULL },
};

// ---- What the options say -----------------------------------------------------------------------

static struct vct_options light_options(const void *options)
{
    struct vct_options out = *(const struct vct_options *)options;
    out.decay = 0.0f;
    out.occlusion = false;
    return out;
}

// In even light of the radiance 1/π the irradiance is how much of it comes in.
static struct vct_options occlusion_options(const void *options)
{
    struct vct_options out = *(const struct vct_options *)options;
    out.specular = false;
    out.aperture = 0.0f;
    out.gain = GLM_1_PIf;
    out.bounces = 1;
    out.lamps = false;
    out.occlusion = true;
    return out;
}

static bool check(const char *name, const struct technique_create *how,
                  const struct vct_options *options)
{
    if (options->resolution % 16 != 0)
        return host_fail(how->host, FAIL_ARGUMENT, "gi %s: resolution=%d is not a multiple of 16",
                         name, (int)options->resolution);
    if (options->levels > 1 && vct_has_svo(options))
        return host_fail(how->host, FAIL_ARGUMENT,
                         "gi %s: levels=%d needs storage=mips: with storage=svo there is one grid",
                         name, (int)options->levels);
    const struct gpu_image_desc light = vct_light_desc(options);
    const uint32_t most = gpu_limits(how->gpu)->max_image_3d,
                   width = light.width > light.depth ? light.width : light.depth;
    if (most < width)
        return host_fail(how->host, FAIL_UNSUPPORTED,
                         "gi %s: resolution=%d, levels=%d: the device has 3D images of at most %u, "
                         "%u are needed",
                         name, (int)options->resolution, (int)options->levels, most, width);
    return true;
}

static bool vct_check(const struct technique_create *how)
{
    const struct vct_options options = light_options(how->options);
    return check("vct", how, &options);
}

static bool vctao_check(const struct technique_create *how)
{
    const struct vct_options options = occlusion_options(how->options);
    return check("vctao", how, &options);
}

// ---- Life ---------------------------------------------------------------------------------------

static bool vct_resize(void *state, uint32_t width, uint32_t height)
{
    struct vct *vct = state;
    return vct_create_images(vct, width, height) &&
           (!vct->options.temporal || vct_temporal_resize(&vct->temporal, vct->gpu, width, height));
}

static bool create(struct vct *vct, const char *name, const struct technique_create *how,
                   struct vct_options options)
{
    if (how->pose) vct_remark_on_scene(how->host, name, &options, how->pose);
    vct->name = vct->temporal.owner = name;
    vct->gpu = how->gpu;
    vct->options = options;
    vct->temporal.unlit = options.occlusion;
    vct->clip_count = vct_clip_count(&vct->options);
    vct_cone_lines(vct->options.cones, vct->lines);
    if (vct->options.specular) vct_fill_shares(&vct->shares);
    return vct_resize(vct, how->width, how->height) && vct_create_resources(vct) &&
           vct_create_pipelines(vct) &&
           (!vct->options.temporal || vct_temporal_create(&vct->temporal, vct->gpu));
}

static bool vct_create(void *state, const struct technique_create *how)
{
    return create(state, "vct", how, light_options(how->options));
}

static bool vctao_create(void *state, const struct technique_create *how)
{
    return create(state, "vctao", how, occlusion_options(how->options));
}

static void forget_voxels(struct vct *vct)
{
    for (int i = 0; i < vct->clip_count; i++) vct->clips[i].rest_valid = false;
    vct->lamps.chosen = false;
}

static void set_options(struct vct *vct, struct vct_options options)
{
    const struct vct_options had = vct->options;
    vct->options = options;
    vct->options.resolution = had.resolution; // what the buffers and pipelines are for
    vct->options.levels = had.levels;
    vct->options.anisotropic = had.anisotropic;
    vct->options.storage = had.storage;
    vct->options.temporal = had.temporal;
    vct->options.half = had.half;
    vct->options.specular = had.specular;
    if (vct->options.lamps != had.lamps) forget_voxels(vct);
    // What shapes the light from voxel to voxel; what only shapes pixels leaves it as it is.
    if (vct->options.bounces != had.bounces || vct->options.offset != had.offset ||
        vct->options.stride != had.stride)
        vct->light_valid = vct->brought_valid = false;
    vct_cone_lines(vct->options.cones, vct->lines);
    vct_temporal_forget(&vct->temporal);
}

static void vct_set_options(void *state, const void *options)
{
    set_options(state, light_options(options));
}

static void vctao_set_options(void *state, const void *options)
{
    set_options(state, occlusion_options(options));
}

static void vct_invalidate(void *state, uint32_t changes)
{
    struct vct *vct = state;
    if (changes & (CHANGED_GEOMETRY | CHANGED_MATERIAL)) forget_voxels(vct);
    vct_temporal_forget(&vct->temporal);
}

// ---- Frames -------------------------------------------------------------------------------------

// Without anything in the grid there is no light, and nothing in the way.
static void clear(const struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const float open = vct->options.occlusion ? 1.0f : 0.0f;
    gpu_clear_image(cmd, vct_result(vct, view), (const float[4]){ open, open, open, 1.0f });
    if (vct->options.specular)
        gpu_clear_image(cmd, view->layers[FRAME_SPECULAR],
                        (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
}

// Lamps are mirrored as they lie in the light volume, and then taken out of it.
static void record_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const bool specular = vct->options.specular, lamps = vct->lamps.count > 0;
    vct->params.lamps_shown = specular && lamps;
    vct_record_light(vct, cmd, view);
    if (specular) vct_record_specular(vct, cmd, view);
    vct->params.lamps_shown = false;
    if (specular && lamps) vct_record_fill(vct, cmd);
}

static void vct_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct vct *vct = state;
    if (!vct_prepare(vct, view)) {
        clear(vct, cmd, view);
        vct_temporal_forget(&vct->temporal);
        return;
    }
    if (vct->options.temporal)
        vct_temporal_begin(&vct->temporal, view, vct->options.frames, vct->options.clamp);
    if (vct->options.lamps)
        vct_lamps_update(&vct->lamps, view, vct->temporal.number);
    else
        vct->lamps.count = 0;
    vct_record_voxels(vct, cmd, view);
    if (!vct->options.occlusion) vct_record_bounce(vct, cmd, view);
    record_light(vct, cmd, view);
    vct_record_cones(vct, cmd, view);
    if (vct->options.temporal)
        vct_temporal_record(&vct->temporal, cmd, view, vct_result(vct, view));
}

static void vct_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    struct vct *vct = state;
    if (!vct->ready) {
        gpu_clear_image(cmd, out, (const float[4]){ 0.0f, 0.0f, 0.0f, 1.0f });
        return;
    }
    vct_record_debug(vct, cmd, view,
                     strcmp(name, "normals") == 0    ? VCT_VIEW_NORMAL
                     : strcmp(name, "radiance") == 0 ? VCT_VIEW_RADIANCE
                     : strcmp(name, "room") == 0     ? VCT_VIEW_ROOM
                     : strcmp(name, "levels") == 0   ? VCT_VIEW_LEVELS
                                                     : VCT_VIEW_REFLECTANCE,
                     out);
}

static void vct_destroy(void *state)
{
    struct vct *vct = state;
    if (!vct->gpu) return;
    vct_temporal_destroy(&vct->temporal, vct->gpu);
    vct_destroy_pipelines(vct);
    vct_destroy_resources(vct);
}

static uint32_t vct_more_needs(const void *options)
{
    const struct vct_options *o = options;
    return (o->temporal ? FRAME_NEEDS_MOTION : 0) | (o->specular ? FRAME_WRITES_SPECULAR : 0);
}

static uint32_t vctao_more_needs(const void *options)
{
    const struct vct_options plain = occlusion_options(options);
    return vct_more_needs(&plain);
}

static uint64_t memory_estimate(struct vct_options options, uint32_t width, uint32_t height)
{
    return vct_resource_bytes(&options, width, height) +
           (options.temporal ? vct_temporal_memory(width, height) : 0);
}

static uint64_t vct_memory_estimate(const void *options, uint32_t width, uint32_t height)
{
    return memory_estimate(light_options(options), width, height);
}

static uint64_t vctao_memory_estimate(const void *options, uint32_t width, uint32_t height)
{
    return memory_estimate(occlusion_options(options), width, height);
}

const struct technique technique_vct = {
    .name = "vct",
    .title = "voxel cone tracing",
    .paper = "Hong 2015, Temporal Voxel Cone Tracing with Interleaved Sample Patterns, ch. 2.5.3, "
             "4; Crassin et al. 2011",
    .role = ROLE_SOURCE,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | MAKES_SPECULAR | GATHERS_EMISSION,
    .needs = FRAME_WRITES_IRRADIANCE,
    .options = OPTION_TABLE(struct vct_options, option_rows, NULL),
    .presets = presets,
    .debug_views = debug_views,
    .state_size = sizeof(struct vct),
    .more_needs = vct_more_needs,
    .check = vct_check,
    .create = vct_create,
    .resize = vct_resize,
    .set_options = vct_set_options,
    .invalidate = vct_invalidate,
    .record = vct_record,
    .debug_view = vct_debug_view,
    .destroy = vct_destroy,
    .memory_estimate = vct_memory_estimate,
};

const struct technique technique_vctao = {
    .name = "vctao",
    .title = "ambient occlusion by voxel cones",
    .paper = "Hong 2015, Temporal Voxel Cone Tracing with Interleaved Sample Patterns, "
             "sec. 2.5.3.3.8; Crassin et al. 2011",
    .folder = "vct",
    .role = ROLE_VISIBILITY,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS,
    .needs = FRAME_WRITES_VISIBILITY,
    .options = OPTION_TABLE(struct vct_options, occlusion_rows, NULL),
    .presets = occlusion_presets,
    .debug_views = occlusion_views,
    .state_size = sizeof(struct vct),
    .more_needs = vctao_more_needs,
    .check = vctao_check,
    .create = vctao_create,
    .resize = vct_resize,
    .set_options = vctao_set_options,
    .invalidate = vct_invalidate,
    .record = vct_record,
    .debug_view = vct_debug_view,
    .destroy = vct_destroy,
    .memory_estimate = vctao_memory_estimate,
};
