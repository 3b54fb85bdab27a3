// Screen-space reflections: hierarchical depth march (Uludag 2014), sampling of the GGX lobe
// (Heitz 2018), reuse of neighbouring rays (Stachowiak 2015). README.md lists the differences.
#include "techniques/ssr/ssr.h"

#include "techniques/ssr/ssr_shared.h"

#include "technique_shaders.h"

#include <stddef.h>
#include <string.h>

enum { LOCAL = 8, PATTERN = 16, TEMPORAL_FRAMES = 16 };
enum { SSR_REUSE_1, SSR_REUSE_4, SSR_REUSE_16 };

// Single frames are blurred against noise, which frames that accumulate have less of: wider mips,
// and smoother surfaces (roughness) before rays are spread over the whole lobe.
static const float MIP_SCALE = 2, ACCUMULATED_MIP_SCALE = 0.5f;
static const float SPREAD = 0.2f, ACCUMULATED_SPREAD = 0.1f;

struct ssr_options {
#define OPTION OPTION_FIELD
#include "techniques/ssr/ssr_options.def"
#undef OPTION
};

static const struct option_row option_rows[] = {
#define OPTION(...) OPTION_ROW(struct ssr_options, __VA_ARGS__)
#include "techniques/ssr/ssr_options.def"
#undef OPTION
};

struct ssr {
    struct ssr_options options;
    gpu_image radiance;                       // RGBA16F: of the frame's pixels
    gpu_image pyramid;                        // R32F: nearest depths
    gpu_image hits, rays;                     // of traced pixels: see ssr_trace.comp
    gpu_image mean;                           // RGBA16F: of this frame, with `temporal`
    gpu_image history[2], history_surface[2]; // previous and current alternate
    gpu_sampler linear;
    gpu_pipeline radiate, average, first_level, next_level, trace, resolve, accumulate, view;
    int newest; // index into history
    bool has_history;
    uint32_t number; // of the frame, from the beginning of the history
};

// ---- objects

static uint32_t step_of(const struct ssr_options *o)
{
    return o->half_resolution ? 2 : 1;
}

static uint32_t padded(uint32_t size)
{
    const uint32_t cell = 1u << (SSR_LEVELS - 1);
    return size ? gpu_groups(size, cell) * cell : 0;
}

static uint32_t mips_of(uint32_t width, uint32_t height)
{
    uint32_t mips = 1;
    while (mips < SSR_MIPS && (width | height) >> mips) mips++;
    return mips;
}

static void add_pipelines(const struct ssr_options *o, struct gpu_objects *out)
{
    const uint32_t step = 1u << SSR_CONSTANT_STEP, reuse = 1u << SSR_CONSTANT_REUSE;
    out->constants[SSR_CONSTANT_STEP] = (struct gpu_constant){ SSR_CONSTANT_STEP, step_of(o) };
    out->constants[SSR_CONSTANT_REUSE] =
        (struct gpu_constant){ SSR_CONSTANT_REUSE, 1u << o->reuse };
#define MEMBER(member) offsetof(struct ssr, member)
    GPU_ADD(
        out, 0, { GPU_PIPELINE, "radiance", MEMBER(radiate), .shader = &shader_ssr_radiance_comp },
        { GPU_PIPELINE, "mips", MEMBER(average), .shader = &shader_ssr_mip_comp },
        { GPU_PIPELINE, "pyramid", MEMBER(first_level), .shader = &shader_ssr_nearest_first_comp },
        { GPU_PIPELINE, "pyramid", MEMBER(next_level), .shader = &shader_ssr_nearest_next_comp },
        { GPU_PIPELINE, "trace", MEMBER(trace), .shader = &shader_ssr_trace_comp,
          .consts = step | reuse },
        { GPU_PIPELINE, "resolve", MEMBER(resolve), .consts = step | reuse,
          .shader = o->temporal ? &shader_ssr_resolve_keep_comp : &shader_ssr_resolve_apply_comp },
        { GPU_PIPELINE, "temporal", MEMBER(accumulate), .consts = step,
          .shader = o->temporal ? &shader_ssr_temporal_comp : NULL },
        { GPU_PIPELINE, "view", MEMBER(view), .shader = &shader_ssr_view_comp, .consts = step });
#undef MEMBER
}

// Views share the memory of all but the history.
static void ssr_objects(const void *options, int view, uint32_t width, uint32_t height,
                        struct gpu_objects *out)
{
    const struct ssr_options *o = options;
    (void)view;
    const struct gpu_image_desc none = { .width = 0 };
    const struct gpu_image_desc whole = {
        .format = GPU_RGBA16F, .width = width, .height = height, .usage = GPU_SAMPLED | GPU_STORAGE
    };
    struct gpu_image_desc radiance = whole, pyramid = whole, hits = whole, rays = whole,
                          mean = o->temporal ? whole : none, history = mean, surface = mean;
    radiance.alias = "ssr.radiance";
    radiance.mips = mips_of(width, height);
    pyramid.alias = "ssr.pyramid";
    pyramid.format = GPU_R32F;
    pyramid.width = padded(width);
    pyramid.height = padded(height);
    pyramid.mips = SSR_LEVELS;
    hits.width = rays.width = gpu_groups(width, step_of(o));
    hits.height = rays.height = gpu_groups(height, step_of(o));
    hits.format = GPU_RGBA32F;
    hits.alias = "ssr.hits";
    rays.alias = "ssr.rays";
    mean.alias = "ssr.mean";
    surface.format = GPU_RG32F;
#define MEMBER(member) offsetof(struct ssr, member), .of_view = true
    GPU_ADD(out, 0, { GPU_SAMPLER, "linear", offsetof(struct ssr, linear), .of_view = false },
            { GPU_IMAGE, "radiance", MEMBER(radiance), .image = radiance },
            { GPU_IMAGE, "pyramid", MEMBER(pyramid), .image = pyramid },
            { GPU_IMAGE, "hits", MEMBER(hits), .image = hits },
            { GPU_IMAGE, "rays", MEMBER(rays), .image = rays },
            { GPU_IMAGE, "mean", MEMBER(mean), .image = mean },
            { GPU_IMAGE, "history", MEMBER(history[0]), .image = history },
            { GPU_IMAGE, "history", MEMBER(history[1]), .image = history },
            { GPU_IMAGE, "history_surface", MEMBER(history_surface[0]), .image = surface },
            { GPU_IMAGE, "history_surface", MEMBER(history_surface[1]), .image = surface });
#undef MEMBER
    add_pipelines(o, out);
}

static uint32_t ssr_more_needs(const void *options)
{
    return ((const struct ssr_options *)options)->temporal ? FRAME_NEEDS_MOTION : 0;
}

static void ssr_set_options(void *state, const void *options)
{
    (void)options;
    ((struct ssr *)state)->has_history = false;
}

static bool ssr_resize(void *state, int view, uint32_t width, uint32_t height)
{
    (void)view, (void)width, (void)height;
    ((struct ssr *)state)->has_history = false;
    return true;
}

// ---- a frame

// A new size begins with a cut of the camera.
static void use_history(struct ssr *ssr, const struct frame_view *view)
{
    ssr->has_history &= ssr->options.temporal && !view->camera_cut && view->index > 0;
    ssr->number = ssr->has_history ? ssr->number + 1 : 0;
    ssr->newest = 1 - ssr->newest;
}

static struct ssr_params params_of(const struct ssr *ssr, const struct frame_view *view)
{
    const struct ssr_options *o = &ssr->options;
    return (struct ssr_params){
        .width = view->width,
        .height = view->height,
        .work_width = gpu_groups(view->width, step_of(o)),
        .work_height = gpu_groups(view->height, step_of(o)),
        .steps = (uint32_t)o->steps,
        .first_sample = PATTERN * (ssr->number % TEMPORAL_FRAMES),
        .has_dielectric = view->layers[FRAME_DIELECTRIC].id != 0,
        .has_history = ssr->has_history,
        .has_visibility = view->layers[FRAME_VISIBILITY].id ? 1.0f : 0.0f,
        .thickness_m = o->thickness,
        .max_roughness = o->max_roughness,
        .mip_scale = o->temporal ? ACCUMULATED_MIP_SCALE : MIP_SCALE,
        .spread_roughness = o->temporal ? ACCUMULATED_SPREAD : SPREAD,
        .border_px = o->border * (float)view->height,
        .pixel_m = frame_camera_pixel(&view->camera, view->width, view->height),
        .focal_px = 1.0f / frame_camera_pixel(&view->camera, view->width, view->height),
    };
}

static void dispatch(struct gpu_cmd *cmd, gpu_pipeline pipeline, const struct gpu_binding *bindings,
                     int count, uint32_t width, uint32_t height)
{
    gpu_dispatch(cmd, pipeline, bindings, count, NULL, 0, gpu_groups(width, LOCAL),
                 gpu_groups(height, LOCAL), 1);
}

static uint32_t halved(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

static void record_radiance(const struct ssr *ssr, struct gpu_cmd *cmd,
                            const struct frame_view *view, struct gpu_binding params)
{
    const gpu_image *layers = view->layers;
    const gpu_image visibility =
        layers[FRAME_VISIBILITY].id ? layers[FRAME_VISIBILITY] : layers[FRAME_ALBEDO];
    gpu_scope_begin(cmd, "radiance");
    dispatch(cmd, ssr->radiate,
             GPU_BIND(view->constants_binding, params,
                      { .name = "direct", .image = layers[FRAME_DIRECT] },
                      { .name = "albedo", .image = layers[FRAME_ALBEDO] },
                      { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
                      { .name = "visibility", .image = visibility },
                      { .name = "specular", .image = layers[FRAME_SPECULAR] },
                      { .name = "radiance", .image = ssr->radiance }),
             view->width, view->height);
    for (uint32_t mip = 1; mip < mips_of(view->width, view->height); mip++)
        dispatch(cmd, ssr->average,
                 GPU_BIND({ .name = "finer",
                            .image = ssr->radiance,
                            .sampler = ssr->linear,
                            .mip = mip - 1,
                            .one_mip = true },
                          { .name = "mip", .image = ssr->radiance, .mip = mip }),
                 halved(view->width, mip), halved(view->height, mip));
    gpu_scope_end(cmd);
}

static void record_pyramid(const struct ssr *ssr, struct gpu_cmd *cmd,
                           const struct frame_view *view)
{
    struct gpu_binding finer = { .name = "finer", .image = view->layers[FRAME_DEPTH] };
    gpu_scope_begin(cmd, "pyramid");
    for (uint32_t level = 0; level < SSR_LEVELS; level++) {
        dispatch(cmd, level ? ssr->next_level : ssr->first_level,
                 GPU_BIND(finer, { .name = "level", .image = ssr->pyramid, .mip = level }),
                 padded(view->width) >> level, padded(view->height) >> level);
        finer = (struct gpu_binding){
            .name = "finer", .image = ssr->pyramid, .mip = level, .one_mip = true
        };
    }
    gpu_scope_end(cmd);
}

static void record_trace(const struct ssr *ssr, struct gpu_cmd *cmd, const struct frame_view *view,
                         struct gpu_binding params)
{
    gpu_scope_begin(cmd, "trace");
    dispatch(
        cmd, ssr->trace,
        GPU_BIND(FRAME_SURFACE_BINDINGS(view), params, { .name = "pyramid", .image = ssr->pyramid },
                 { .name = "radiance", .image = ssr->radiance, .sampler = ssr->linear },
                 { .name = "hits", .image = ssr->hits }, { .name = "rays", .image = ssr->rays }),
        gpu_groups(view->width, step_of(&ssr->options)),
        gpu_groups(view->height, step_of(&ssr->options)));
    gpu_scope_end(cmd);
}

static void record_resolve(const struct ssr *ssr, struct gpu_cmd *cmd,
                           const struct frame_view *view, struct gpu_binding params)
{
    gpu_scope_begin(cmd, "resolve");
    dispatch(cmd, ssr->resolve,
             GPU_BIND(FRAME_SURFACE_BINDINGS(view), params, { .name = "hits", .image = ssr->hits },
                      { .name = "rays", .image = ssr->rays },
                      { .name = "mean", .image = ssr->mean },
                      { .name = "specular", .image = view->layers[FRAME_SPECULAR] }),
             view->width, view->height);
    gpu_scope_end(cmd);
}

static void record_temporal(const struct ssr *ssr, struct gpu_cmd *cmd,
                            const struct frame_view *view, struct gpu_binding params)
{
    const int now = ssr->newest, before = 1 - now;
    gpu_scope_begin(cmd, "temporal");
    dispatch(cmd, ssr->accumulate,
             GPU_BIND(FRAME_SURFACE_BINDINGS(view), params, { .name = "hits", .image = ssr->hits },
                      { .name = "mean", .image = ssr->mean },
                      { .name = "motion", .image = view->layers[FRAME_MOTION] },
                      { .name = "specular", .image = view->layers[FRAME_SPECULAR] },
                      { .name = "history", .image = ssr->history[before] },
                      { .name = "history_surface", .image = ssr->history_surface[before] },
                      { .name = "target", .image = ssr->history[now] },
                      { .name = "target_surface", .image = ssr->history_surface[now] }),
             view->width, view->height);
    gpu_scope_end(cmd);
}

static void ssr_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct ssr *ssr = state;
    use_history(ssr, view);
    const struct ssr_params values = params_of(ssr, view);
    const struct gpu_binding params = gpu_transient(cmd, "ssr", &values, sizeof values);
    record_radiance(ssr, cmd, view, params);
    record_pyramid(ssr, cmd, view);
    record_trace(ssr, cmd, view, params);
    record_resolve(ssr, cmd, view, params);
    if (ssr->options.temporal) record_temporal(ssr, cmd, view, params);
    ssr->has_history = ssr->options.temporal;
}

static void ssr_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    const struct ssr *ssr = state;
    const struct ssr_params values = params_of(ssr, view);
    const struct ssr_view_push push = { .distance = strcmp(name, "hit_distance") == 0 };
    gpu_scope_begin(cmd, "view");
    gpu_dispatch(
        cmd, ssr->view,
        GPU_BIND(view->constants_binding, gpu_transient(cmd, "ssr", &values, sizeof values),
                 { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                 { .name = "hits", .image = ssr->hits }, { .name = "rays", .image = ssr->rays },
                 { .name = "target", .image = out }),
        &push, sizeof push, gpu_groups(view->width, LOCAL), gpu_groups(view->height, LOCAL), 1);
    gpu_scope_end(cmd);
}

static const struct technique_debug_view debug_views[] = {
    { "confidence", "share of each pixel's ray in its reflection: white for a certain hit", NULL },
    { "hit_distance", "distance of each ray's hit: black at 0, half grey at 1 m, white far away",
      NULL },
    { NULL, NULL, NULL },
};

static const struct technique_preset presets[] = {
    { "low", "half_resolution=true,reuse=4,steps=48" },
    { "medium", "" },
    { "high", "temporal=true,steps=96" },
    { NULL, NULL },
};

const struct technique technique_ssr = {
    .name = "ssr",
    .title = "reflections in screen space, in front of the source's",
    .paper = "Uludag 2014, Hi-Z Screen-Space Cone-Traced Reflections; Stachowiak 2015, Stochastic "
             "Screen-Space Reflections; Heitz 2018, Sampling the GGX Distribution of Visible "
             "Normals",
    .role = ROLE_REFLECTION,
    .capabilities = CAN_MOVE_GEOMETRY | CAN_MOVE_LIGHTS | MAKES_SPECULAR,
    .needs = FRAME_WRITES_SPECULAR,
    .more_needs = ssr_more_needs,
    .options = OPTION_TABLE(struct ssr_options, option_rows, NULL),
    .presets = presets,
    .debug_views = debug_views,
    .state_size = sizeof(struct ssr),
    .objects = ssr_objects,
    .resize = ssr_resize,
    .set_options = ssr_set_options,
    .record = ssr_record,
    .debug_view = ssr_debug_view,
};
