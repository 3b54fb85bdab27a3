// Renderers: creation, resizing, destruction.
#include "api/renderer/bakes.h"
#include "api/renderer/gbuffer.h"
#include "api/renderer/state.h"

#include "gpu/gpu.h"

enum { MAX_SIZE = 16384 };

void ag_renderer_desc_default(struct ag_renderer_desc *desc)
{
    if (!desc) return;
    *desc = (struct ag_renderer_desc){
        .width = 1280, .height = 720, .gi = "none", .display_layer = true
    };
}

enum ag_result renderer_size_check(const char *function, struct ag_context *context, int width,
                                   int height)
{
    AG_REQUIRE_FOR(function, context,
                   width >= 1 && width <= MAX_SIZE && height >= 1 && height <= MAX_SIZE,
                   "width and height must be 1 to %d, not %d and %d", (int)MAX_SIZE, width, height);
    return AG_OK;
}

bool renderer_parse_frame_options(struct host *host, const char *text, struct frame_options *out)
{
    option_defaults(&frame_option_table, out);
    return option_parse(host, &frame_option_table, "frame", text ? text : "", out);
}

// Parses both texts of a description. Finish *spec in any case.
static bool parse_options(struct host *host, const struct ag_renderer_desc *desc,
                          struct gi_spec *spec, struct frame_options *options)
{
    return renderer_parse_frame_options(host, desc->frame_options, options) &&
           gi_spec_parse(spec, host, desc->gi ? desc->gi : "");
}

bool renderer_parse_quietly(struct ag_context *context, const struct ag_renderer_desc *desc,
                            struct gi_spec *spec, struct frame_options *options)
{
    struct host *host = &context->host;
    const enum log_level log_up_to = host->log_up_to;
    host->log_up_to = LOG_ERROR; // ag_renderer_create logs the same warnings
    const bool ok = parse_options(host, desc, spec, options);
    if (ok) gi_spec_fit(spec, desc->scene_size_m);
    host->log_up_to = log_up_to;
    return ok;
}

struct frame_input renderer_wants(const struct ag_renderer_desc *desc)
{
    static const struct frame_gbuffer some;
    return (struct frame_input){
        .want_indirect_layer = desc->indirect_layer,
        .want_motion_layer = desc->motion_layer,
        .want_id_layer = desc->id_layer,
        .want_display = desc->display_layer,
        // Converted ones have all images of the frame's own.
        .gbuffer = desc->host_gbuffer && !desc->gbuffer_layout ? &some : NULL,
    };
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
    AG_REQUIRE_KNOWN(__func__, context, desc);
    AG_REQUIRE(context, light_count >= 0, "light_count %d is negative", light_count);
    enum ag_result checked = renderer_size_check(__func__, context, desc->width, desc->height);
    if (checked != AG_OK) return checked;
    struct gi_spec spec = { 0 };
    struct frame_options options;
    const bool ok = renderer_parse_quietly(context, desc, &spec, &options);
    const uint32_t width = (uint32_t)desc->width, height = (uint32_t)desc->height;
    struct frame_input input = renderer_wants(desc);
    input.light_count = light_count < FRAME_MAX_LIGHTS ? light_count : FRAME_MAX_LIGHTS;
    if (ok)
        *bytes = frame_memory_estimate(&options, &input, gi_spec_needs(&spec), width, height) +
                 gi_memory_estimate(&spec, width, height);
    gi_spec_finish(&spec);
    return api_done(context, ok);
}

// ---- creation and destruction

// Without a technique that gathers emission, such a scene is black except for its emitters.
void renderer_warn_of_darkness(const struct ag_renderer *r)
{
    const struct scene *scene = r->scene->scene;
    struct world_light sun;
    bool only_emitters = scene->light_count == 0 && environment_is_black(&scene->environment) &&
                         !environment_sun_light(&scene->environment, &sun) &&
                         scene_has_emission(scene);
    if (only_emitters && !gi_spec_gathers_emission(&r->spec))
        host_log(renderer_host(r), LOG_WARNING,
                 "%s: only emissive surfaces light the scene and --gi %s ignores their light; try "
                 "--gi lpv",
                 scene->name, r->gi_text);
}

void renderer_warn_of_source(const struct ag_renderer *r)
{
    const struct gi_spec *spec = &r->spec;
    if (spec->added_source)
        host_log(renderer_host(r), LOG_WARNING,
                 "--gi %s has no source of indirect light: using %s+%s",
                 spec->technique[spec->count - 1]->name, spec->technique[0]->name,
                 spec->technique[spec->count - 1]->name);
}

static bool build(struct ag_renderer *r, const struct ag_renderer_desc *desc)
{
    struct host *host = renderer_host(r);
    uint32_t width = (uint32_t)desc->width, height = (uint32_t)desc->height;
    if (!parse_options(host, desc, &r->spec, &r->options)) return false;
    if (!(r->gi_text = gi_spec_print(&r->spec))) return false;
    if (desc->bake_folder && !(r->bake_folder = host_strdup(host, desc->bake_folder))) return false;
    if (!api_pose_at(r->scene, &r->pose, 0, 0.0)) return false;
    r->seen = r->scene->scene->revisions;
    renderer_keep_surfaces(r);
    if (!(r->main.frame = frame_create(host, r->device->gpu, &r->options))) return false;
    if (!frame_set_scene(r->main.frame, r->scene->scene)) return false;
    if (!frame_resize(r->main.frame, width, height)) return false;
    struct renderer_bakes bakes = { 0 };
    if (renderer_bakes_find(&bakes, host, desc, &r->spec, NULL, &r->pose))
        r->gi =
            gi_create_baked(host, r->device->gpu, &r->spec, &bakes.found, &r->pose, width, height);
    renderer_bakes_finish(&bakes);
    r->main.sized = r->gi != NULL;
    if (r->main.sized) renderer_warn_of_source(r);
    if (r->main.sized) renderer_warn_of_darkness(r);
    return r->main.sized;
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
    AG_REQUIRE_KNOWN(__func__, context, desc);
    AG_REQUIRE(context, !desc->host_gbuffer || !desc->id_layer,
               "id_layer and host_gbuffer exclude each other: a program's own G-buffer has no ids");
    enum ag_result checked = renderer_size_check(__func__, context, desc->width, desc->height);
    if (checked != AG_OK) return checked;
    checked = renderer_bakes_check(__func__, context, desc->bakes, desc->bake_count);
    if (checked == AG_OK)
        checked =
            renderer_layout_check(__func__, context, desc->host_gbuffer, desc->gbuffer_layout);
    if (checked != AG_OK) return checked;

    struct ag_renderer *r = host_alloc(&context->host, 1, sizeof *r);
    if (!r) return api_done(context, false);
    r->device = device;
    r->scene = scene;
    r->main.renderer = r;
    r->main.width = desc->width;
    r->main.height = desc->height;
    r->main.indirect_layer = desc->indirect_layer;
    r->main.display_layer = desc->display_layer;
    r->main.motion_layer = desc->motion_layer;
    r->main.id_layer = desc->id_layer;
    r->main.host_gbuffer = desc->host_gbuffer;
    r->main.has_layout = desc->gbuffer_layout;
    if (desc->gbuffer_layout) r->main.layout = *desc->gbuffer_layout;
    r->wait_for_updates = desc->wait_for_updates;
    r->main.shown.layer = FRAME_COLOR;
    lifetime_use(&device->life);
    api_scene_use(scene, &scene->renderers);
    r->client = gpu_client_add(device->gpu);
    renderer_enter(r);
    bool ok = r->client && build(r, desc);
    renderer_leave(r);
    enum ag_result result = api_done(context, ok);
    if (!ok)
        ag_renderer_destroy(r);
    else
        *out = r;
    return result;
}

static void free_renderer(struct ag_renderer *r)
{
    struct ag_device *device = r->device;
    struct ag_scene *scene = r->scene;
    renderer_recordings_done(r, UINT64_MAX);
    if (r->gi) gi_destroy(r->gi);
    frame_destroy(r->main.frame);
    pose_finish(&r->pose);
    gi_spec_finish(&r->spec);
    host_free(renderer_host(r), r->gi_text);
    host_free(renderer_host(r), r->bake_folder);
    gpu_client_remove(device->gpu, r->client);
    host_free(renderer_host(r), r);
    api_scene_release(scene, &scene->renderers);
    api_device_release(device);
}

void renderer_release(struct ag_renderer *r)
{
    if (lifetime_release(&r->life)) free_renderer(r);
}

void ag_renderer_destroy(struct ag_renderer *r)
{
    if (r && lifetime_destroy(&r->life)) free_renderer(r);
}

enum ag_result ag_renderer_resize(struct ag_renderer *r, int width, int height)
{
    struct ag_context *context = renderer_context(r);
    AG_REQUIRE(context, r, "renderer is NULL");
    enum ag_result checked = renderer_size_check(__func__, context, width, height);
    if (checked != AG_OK) return checked;
    r->main.rendered = 0;
    r->main.width = width;
    r->main.height = height;
    renderer_enter(r);
    r->main.sized = frame_resize(r->main.frame, (uint32_t)width, (uint32_t)height) &&
                    gi_resize(r->gi, (uint32_t)width, (uint32_t)height);
    renderer_leave(r);
    return api_done(context, r->main.sized);
}

bool ag_renderer_is_updating(const struct ag_renderer *r)
{
    return r && r->main.rendered && gi_is_updating(r->gi);
}

const char *ag_renderer_gi(const struct ag_renderer *r)
{
    return r ? r->gi_text : "";
}

int ag_renderer_reload_shaders(struct ag_renderer *r)
{
    return r ? gpu_reload_shaders(r->device->gpu) : 0;
}
