// The viewer's life: a window, and in it one scene after another.
#include "viewer.h"

#include "viewer/scene/changes.h"
#include "frame.h"
#include "operations.h"
#include "viewer/methods/running.h"
#include "viewer/script/script.h"
#include "viewer/scene/session_file.h"
#include "viewer/scene/undo.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The device is lost: what the user did is not.
static void rescue(struct viewer *v, char error[1024])
{
    static const char *const PATH = "afterglow-rescued.json";
    const bool kept = session_file_write(v, PATH);
    snprintf(error, 1024,
             "the Vulkan device was lost or gives no more images: begin again with a smaller "
             "--size or --scale%s%s",
             kept ? " and --session " : "", kept ? PATH : "");
}

static bool loop(struct viewer *v, char error[1024])
{
    double last = window_seconds();
    while (!v->quit && !v->next && !window_should_close(v->window) &&
           (v->desc->frames == 0 || v->frame < (uint64_t)v->desc->frames)) {
        const double now = window_seconds();
        const float seconds = v->script ? 1.0f / 60.0f : fminf((float)(now - last), 0.25f);
        v->frame_s += 0.1f * ((float)(now - last) - v->frame_s);
        if (v->frame > 0) pace_add(&v->pace, 1000.0f * (float)(now - last));
        last = now;
        if (!frame_step(v, seconds)) {
            rescue(v, error);
            return false;
        }
        v->frame++;
    }
    return true;
}

// ---- opening and closing

static const char *clipboard(void *window)
{
    return window_clipboard(window);
}

static void set_clipboard(void *window, const char *text)
{
    window_set_clipboard(window, text);
}

static bool open(struct viewer *v, char error[1024])
{
    const struct viewer_desc *desc = v->desc;
    char why[512];
    v->window = window_open("Afterglow", desc->width, desc->height, why);
    int width, height;
    if (v->window) window_pixels(v->window, &width, &height);
    if (!v->window || !gpu_open(&v->gpu, v->window, desc->device, desc->validate, why)) {
        snprintf(error, 1024, "%s", why);
        return false;
    }
    const struct interface_desc interface = {
        .gpu = &v->gpu,
        .swapchain = &v->swapchain,
        .scale = window_scale(v->window),
        .user = v->window,
        .clipboard = clipboard,
        .set_clipboard = set_clipboard,
    };
    if (!swapchain_open(&v->swapchain, &v->gpu, width, height) || !interface_open(&interface)) {
        snprintf(error, 1024,
                 "cannot show images in the window: the Vulkan device gives none that "
                 "the viewer supports; use afterglow render");
        return false;
    }
    v->script = desc->script ? script_open(desc->script, error) : NULL;
    return !desc->script || v->script;
}

static void close(struct viewer *v)
{
    script_close(v->script);
    interface_close();
    swapchain_close(&v->swapchain);
}

// ---- a scene

static void set_defaults(struct viewer *v)
{
    const struct viewer_desc *desc = v->desc;
    paint_init(v);
    block_edit_init(v);
    v->split_at = 0.5f;
    v->budget_ms = 16.7f;
    v->path.seconds = 2.0f;
    v->path.fps = 30;
    v->record.frames_each = 4;
    snprintf(v->record.folder, sizeof v->record.folder, "afterglow-flight");
    v->scene_camera = v->picked_instance = v->show_tab = v->gizmo.light = -1;
    v->pick_at[0] = -1;
    v->gizmo.handle = HANDLE_NONE;
    snprintf(v->file, sizeof v->file, "afterglow.png");
    snprintf(v->session, sizeof v->session, "%s",
             desc->session ? desc->session : "afterglow-session.json");
    v->given = desc->camera;
    v->auto_exposure = !desc->has_exposure;
    v->exposure_ev = desc->exposure_ev;
    v->tonemap = desc->tonemap;
    v->metering = desc->metering;
    v->time_s = desc->time_s;
    ag_device_get_info(v->device, &v->device_info);
    v->scale = desc->scale > 0 ? desc->scale : v->device_info.software ? 0.5f : 1.0f;
    method_init(&v->method);
    method_init(&v->other_method);
}

static bool begin_comparison(struct viewer *v)
{
    const char *split = v->desc->split;
    if (!split) return true;
    return strcmp(split, "reference") == 0 ? viewer_set_reference(v, true)
                                           : viewer_set_split(v, split);
}

static bool begin(struct viewer *v, char error[1024])
{
    const struct viewer_desc *desc = v->desc;
    const struct edits_moment at = viewer_moment(v);
    char title[300];
    snprintf(title, sizeof title, "%.255s · Afterglow", desc->scene_name);
    window_title(v->window, title);
    if (gpu_lend(&v->gpu, desc->context, &v->device) != AG_OK) {
        snprintf(error, 1024, "%s", ag_context_last_error(desc->context));
        return false;
    }
    set_defaults(v);
    edits_begin(&v->edits, &at);
    environments_begin(&v->environments, desc->context, desc->scene, &v->edits.first_environment);
    v->edits.environment = v->edits.first_environment;
    const bool again = v->frame > 0; // the window has had a scene: a failure leaves it open
    if ((!running_begin(v, desc->gi) && !(again && running_begin(v, "none"))) ||
        (!again && !begin_comparison(v))) {
        snprintf(error, 1024, "%s", ag_context_last_error(desc->context));
        return false;
    }
    v->undo = undo_open(v);
    viewer_set_camera(v, -1);
    if (!desc->session || session_file_read(v, desc->session) || again) return true;
    snprintf(error, 1024, "%s", v->message);
    return false;
}

static void end(struct viewer *v)
{
    if (v->gpu.device) vkDeviceWaitIdle(v->gpu.device);
    undo_close(v->undo);
    pixels_forget(v);
    probe_balls_close(v);
    paint_close(v);
    block_edit_close(v);
    running_end(v);
    environments_end(&v->environments);
    ag_device_destroy(v->device);
}

// All but the window and what runs with it begins again.
static void follow(struct viewer *v)
{
    const struct viewer_desc *next = v->next;
    struct window *window = v->window;
    struct script *script = v->script;
    const struct gpu gpu = v->gpu;
    const struct swapchain swapchain = v->swapchain;
    const uint64_t frame = v->frame;
    memset(v, 0, sizeof *v);
    v->desc = next;
    v->window = window;
    v->script = script;
    v->gpu = gpu;
    v->swapchain = swapchain;
    v->frame = frame;
}

static bool show_scene(struct viewer *v, char error[1024])
{
    bool done = begin(v, error) && loop(v, error);
    if (done && v->script && script_failed(v->script, error)) done = false;
    if (done && v->desc->screenshot && v->screenshot_failed) {
        snprintf(error, 1024, "%s", v->message);
        done = false;
    }
    end(v);
    return done;
}

bool viewer_run(const struct viewer_desc *desc, char error[1024])
{
    struct viewer *v = calloc(1, sizeof *v);
    if (!v) {
        snprintf(error, 1024, "cannot open the viewer: out of memory");
        return false;
    }
    v->desc = desc;
    bool done = open(v, error) && show_scene(v, error);
    while (done && v->next) {
        follow(v);
        done = show_scene(v, error);
    }
    close(v);
    if (done && v->gpu.messages > 0) {
        snprintf(error, 1024, "Vulkan validation logged %d messages, the first: %s",
                 v->gpu.messages, v->gpu.message);
        done = false;
    }
    gpu_close(&v->gpu);
    if (v->window) window_close(v->window);
    free(v);
    return done;
}
