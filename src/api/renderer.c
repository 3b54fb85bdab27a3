// Renderers: one frame at a time, from the frame passes and the GI stack.
#include "api/renderer_bakes.h"
#include "api/renderer_state.h"

#include "gpu/gpu.h"

#include <string.h>

enum { MAX_SIZE = 16384, MAX_PASSES = 128, MAX_OWNERS = 128 };

static struct host *host_of(const struct ag_renderer *renderer)
{
    return &renderer->device->context->host;
}

void ag_renderer_desc_default(struct ag_renderer_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_renderer_desc){
        .width = 1280, .height = 720, .gi = "none", .display_layer = true
    };
}

static enum ag_result size_check(const char *function, struct ag_context *context, int width,
                                 int height)
{
    AG_REQUIRE_FOR(function, context,
                   width >= 1 && width <= MAX_SIZE && height >= 1 && height <= MAX_SIZE,
                   "width and height must be 1 to %d, not %d and %d", (int)MAX_SIZE, width, height);
    return AG_OK;
}

// Parses both texts of a description. Finish *spec in any case.
static bool parse_options(struct host *host, const struct ag_renderer_desc *desc,
                          struct gi_spec *spec, struct frame_options *options)
{
    option_defaults(&frame_option_table, options);
    const char *text = desc->frame_options ? desc->frame_options : "";
    return option_parse(host, &frame_option_table, "frame", text, options) &&
           gi_spec_parse(spec, host, desc->gi ? desc->gi : "");
}

enum ag_result ag_renderer_estimate_memory(struct ag_context *context,
                                           const struct ag_renderer_desc *desc, int light_count,
                                           uint64_t *bytes)
{
    AG_REQUIRE_POINTER(context, bytes);
    *bytes = 0;
    AG_REQUIRE_POINTER(context, context);
    struct ag_renderer_desc fallback;
    ag_renderer_desc_default(&fallback);
    if (!desc) desc = &fallback;
    AG_REQUIRE(context, light_count >= 0, "light_count %d is negative", light_count);
    enum ag_result checked = size_check(__func__, context, desc->width, desc->height);
    if (checked != AG_OK) return checked;
    struct gi_spec spec = { 0 };
    struct frame_options options;
    struct host *host = &context->host;
    const enum log_level log_up_to = host->log_up_to;
    host->log_up_to = LOG_ERROR; // ag_renderer_create logs the same warnings
    bool ok = parse_options(host, desc, &spec, &options);
    host->log_up_to = log_up_to;
    uint32_t width = (uint32_t)desc->width, height = (uint32_t)desc->height;
    if (light_count > FRAME_MAX_LIGHTS) light_count = FRAME_MAX_LIGHTS;
    if (ok)
        *bytes = frame_memory_estimate(&options, width, height, light_count) +
                 gi_memory_estimate(&spec, width, height);
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

// ---- creation and destruction

// Without a technique that gathers emission, such a scene is black except for its emitters.
static void warn_of_darkness(const struct ag_renderer *r)
{
    const struct scene *scene = r->scene->scene;
    bool only_emitters =
        scene->light_count == 0 && luminance(scene->sky) <= 0.0f && scene_has_emission(scene);
    if (only_emitters && !gi_spec_gathers_emission(&r->spec))
        host_log(host_of(r), LOG_WARNING,
                 "%s: only emissive surfaces light the scene and --gi %s ignores their light; try "
                 "--gi lpv",
                 scene->name, r->gi_text);
}

static bool build(struct ag_renderer *r, const struct ag_renderer_desc *desc)
{
    struct host *host = host_of(r);
    uint32_t width = (uint32_t)desc->width, height = (uint32_t)desc->height;
    if (!parse_options(host, desc, &r->spec, &r->options)) return false;
    if (!(r->gi_text = gi_spec_print(&r->spec))) return false;
    if (!api_pose_at(r->scene, &r->pose, &r->pose_version, 0, 0.0)) return false;
    if (!(r->frame = frame_create(host, r->device->gpu, &r->options))) return false;
    if (!frame_set_scene(r->frame, r->scene->scene)) return false;
    if (!frame_resize(r->frame, width, height)) return false;
    struct renderer_bakes bakes = { 0 };
    if (renderer_bakes_find(&bakes, host, desc, &r->spec, &r->pose))
        r->gi =
            gi_create_baked(host, r->device->gpu, &r->spec, &bakes.found, &r->pose, width, height);
    renderer_bakes_finish(&bakes);
    r->sized = r->gi != NULL;
    if (r->sized) warn_of_darkness(r);
    return r->sized;
}

enum ag_result ag_renderer_create(struct ag_device *device, struct ag_scene *scene,
                                  const struct ag_renderer_desc *desc, struct ag_renderer **out)
{
    struct ag_context *context = device ? device->context : scene ? scene->context : NULL;
    AG_REQUIRE_OUT(context, out);
    AG_REQUIRE(context, device && scene, "device or scene is NULL");
    AG_REQUIRE(context, device->context == scene->context,
               "device and scene are of different contexts");
    struct ag_renderer_desc fallback;
    ag_renderer_desc_default(&fallback);
    if (!desc) desc = &fallback;
    enum ag_result checked = size_check(__func__, context, desc->width, desc->height);
    if (checked != AG_OK) return checked;
    AG_REQUIRE(context, desc->bake_count >= 0 && (desc->bakes || desc->bake_count == 0),
               "bake_count %d does not fit bakes", desc->bake_count);

    struct ag_renderer *r = host_alloc(&context->host, 1, sizeof *r);
    if (!r) return api_done(context, false);
    r->device = device;
    r->scene = scene;
    r->indirect_layer = desc->indirect_layer;
    r->display_layer = desc->display_layer;
    r->motion_layer = desc->motion_layer;
    scene->users++;
    bool ok = build(r, desc);
    enum ag_result result = api_done(context, ok);
    if (!ok)
        ag_renderer_destroy(r);
    else
        *out = r;
    return result;
}

void ag_renderer_destroy(struct ag_renderer *r)
{
    if (!r) return;
    if (r->recorded) gpu_frame_adopted_done(r->device->gpu, r->recorded);
    if (r->gi) gi_destroy(r->gi);
    frame_destroy(r->frame);
    pose_finish(&r->pose);
    gi_spec_finish(&r->spec);
    host_free(host_of(r), r->gi_text);
    r->scene->users--;
    host_free(host_of(r), r);
}

// A frame recorded into a caller's command buffer must be reported done before any other call.
static enum ag_result idle_check(const char *function, const struct ag_renderer *r)
{
    AG_REQUIRE_FOR(function, renderer_context(r), !r->recorded,
                   "a recorded frame is unfinished: call ag_renderer_recorded_done first");
    return AG_OK;
}

enum ag_result ag_renderer_resize(struct ag_renderer *r, int width, int height)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = size_check(__func__, context, width, height);
    if (checked == AG_OK) checked = idle_check(__func__, r);
    if (checked != AG_OK) return checked;
    r->rendered = 0;
    r->sized = frame_resize(r->frame, (uint32_t)width, (uint32_t)height) &&
               gi_resize(r->gi, (uint32_t)width, (uint32_t)height);
    return api_done(context, r->sized);
}

// ---- frames

void ag_frame_desc_default(struct ag_frame_desc *desc)
{
    if (desc) *desc = (struct ag_frame_desc){ .auto_exposure = true };
}

static enum ag_result frame_check(const char *function, const struct ag_renderer *r,
                                  const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE_FOR(function, context, desc, "desc is NULL");
    AG_REQUIRE_FOR(function, context, r->sized, "the last resize failed");
    AG_REQUIRE_FOR(function, context, api_animation_exists(r->scene, desc->animation),
                   "animation %d is not one of %d", desc->animation,
                   r->scene->scene->animation_count);
    AG_REQUIRE_FOR(function, context, isfinite(desc->time_s), "time_s is not finite");
    AG_REQUIRE_FOR(function, context, desc->auto_exposure || isfinite(desc->exposure_ev),
                   "exposure_ev is not finite");
    enum ag_result checked = api_camera_check(context, function, &desc->camera);
    return checked == AG_OK ? idle_check(function, r) : checked;
}

static int resolve_lights(struct ag_renderer *r)
{
    int count = r->scene->scene->light_count;
    if (count > FRAME_MAX_LIGHTS) {
        if (!r->said_limit)
            host_log(host_of(r), LOG_WARNING, "%s has %d lights: the first %d are used",
                     r->scene->scene->name, count, FRAME_MAX_LIGHTS);
        r->said_limit = true;
        count = FRAME_MAX_LIGHTS;
    }
    for (int i = 0; i < count; i++) r->lights[i] = pose_light(&r->pose, i);
    return count;
}

// All steps that may allocate; recording must not.
static bool prepare(struct ag_renderer *r, const struct ag_frame_desc *desc,
                    struct frame_input *input, struct frame_indirect *hook)
{
    if (!api_pose_at(r->scene, &r->pose, &r->pose_version, desc->animation, desc->time_s))
        return false;
    *input = (struct frame_input){ .pose = &r->pose,
                                   .camera = api_camera(&desc->camera),
                                   .lights = r->lights,
                                   .light_count = resolve_lights(r),
                                   .sky = r->scene->scene->sky,
                                   .auto_exposure = desc->auto_exposure,
                                   .exposure_ev = desc->exposure_ev,
                                   .camera_cut = desc->camera_cut,
                                   .want_indirect_layer = r->indirect_layer,
                                   .want_motion_layer = r->motion_layer,
                                   .want_display = r->display_layer };
    *hook = gi_hook(r->gi);
    return frame_prepare(r->frame, input, hook);
}

static bool fail_lost(struct ag_renderer *r)
{
    struct host *host = host_of(r);
    if (host->failure != FAIL_NONE) return false; // already reported
    return host_fail(host, FAIL_DEVICE, "cannot render a frame on %s: the device is lost",
                     gpu_info(r->device->gpu)->name);
}

enum ag_result ag_renderer_render(struct ag_renderer *r, const struct ag_frame_desc *desc)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = frame_check(__func__, r, desc);
    if (checked != AG_OK) return checked;
    struct frame_input input;
    struct frame_indirect hook;
    if (!prepare(r, desc, &input, &hook)) return api_done(context, false);
    struct gpu_cmd *cmd = gpu_frame_begin(r->device->gpu);
    if (!cmd) return api_done(context, fail_lost(r));
    frame_record(r->frame, cmd, &input, &hook);
    if (!gpu_frame_end(r->device->gpu, cmd)) return api_done(context, fail_lost(r));
    r->rendered++;
    return api_done(context, true);
}

enum ag_result ag_renderer_record(struct ag_renderer *r, const struct ag_frame_desc *desc,
                                  void *vk_command_buffer)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, vk_command_buffer);
    AG_REQUIRE(context, r->device->adopted, "the device is not an adopted one");
    enum ag_result checked = frame_check(__func__, r, desc);
    if (checked != AG_OK) return checked;
    struct frame_input input;
    struct frame_indirect hook;
    if (!prepare(r, desc, &input, &hook)) return api_done(context, false);
    struct gpu_cmd *cmd = gpu_frame_begin_adopted(r->device->gpu, vk_command_buffer);
    if (!cmd) return api_done(context, fail_lost(r));
    frame_record(r->frame, cmd, &input, &hook);
    r->recorded = cmd;
    r->rendered++;
    return api_done(context, gpu_frame_end(r->device->gpu, cmd) || fail_lost(r));
}

enum ag_result ag_renderer_recorded_done(struct ag_renderer *r)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE(context, r->recorded, "no frame was recorded");
    gpu_frame_adopted_done(r->device->gpu, r->recorded);
    r->recorded = NULL;
    return api_done(context, true);
}

enum ag_result ag_renderer_wait(struct ag_renderer *r)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = idle_check(__func__, r);
    if (checked != AG_OK) return checked;
    return api_done(context, gpu_wait(r->device->gpu) || fail_lost(r));
}

// ---- results of a frame

enum ag_result ag_renderer_exposure(struct ag_renderer *r, float *ev)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    AG_REQUIRE_POINTER(context, ev);
    *ev = 0.0f;
    AG_REQUIRE(context, r->rendered, "no frame has been rendered");
    enum ag_result waited = ag_renderer_wait(r);
    if (waited != AG_OK) return waited;
    return api_done(context, frame_exposure(r->frame, ev));
}

enum ag_result ag_renderer_set_debug_view(struct ag_renderer *r, const char *name)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    bool ok = gi_set_debug_view(r->gi, name);
    if (ok) r->debug_view = name != NULL;
    return api_done(context, ok);
}

int ag_renderer_timings(struct ag_renderer *r, struct ag_timing *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    if (!r->rendered || ag_renderer_wait(r) != AG_OK) return 0;
    struct gpu_timing timings[MAX_PASSES];
    int count = gpu_frame_timings(r->device->gpu, timings, MAX_PASSES);
    if (count > MAX_PASSES) count = MAX_PASSES;
    _Static_assert(sizeof out->name == sizeof timings->name, "names are copied whole");
    for (int i = 0; i < count && i < capacity; i++) {
        memcpy(out[i].name, timings[i].name, sizeof out[i].name);
        out[i].ms = timings[i].ms;
    }
    return count;
}

int ag_renderer_memory(struct ag_renderer *r, struct ag_memory *out, int capacity)
{
    if (!r || capacity < 0 || (!out && capacity > 0)) return 0;
    struct gpu_memory owners[MAX_OWNERS];
    int count = gpu_memory_by_owner(r->device->gpu, owners, MAX_OWNERS);
    if (count > MAX_OWNERS) count = MAX_OWNERS;
    _Static_assert(sizeof out->owner == sizeof owners->owner, "names are copied whole");
    for (int i = 0; i < count && i < capacity; i++) {
        memcpy(out[i].owner, owners[i].owner, sizeof out[i].owner);
        out[i].bytes = owners[i].bytes;
    }
    return count;
}

const char *ag_renderer_gi(const struct ag_renderer *r)
{
    return r ? r->gi_text : "";
}

int ag_renderer_reload_shaders(struct ag_renderer *r)
{
    return r ? gpu_reload_shaders(r->device->gpu) : 0;
}
