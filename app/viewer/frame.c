#include "frame.h"

#include "controls.h"
#include "operations.h"
#include "viewer/methods/running.h"
#include "viewer/script/script.h"
#include "viewer/methods/times.h"
#include "viewer/scene/undo.h"
#include "viewer/panels/panels.h"
#include "shell/srgb.h"

#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979324;
static const double IDLE_WAIT_S = 0.1;

// ---- the image

// The camera of the scene follows its animation until the user moves it.
static void update_camera(struct viewer *v)
{
    float target[3];
    if (!v->look.moved) {
        const char *name = ag_scene_camera_name(v->desc->scene, v->scene_camera);
        if (v->scene_camera >= 0 && v->playing &&
            ag_scene_camera(v->desc->scene, name, v->desc->animation, v->time_s, &v->camera) ==
                AG_OK)
            look_follow(&v->look, &v->camera);
        return;
    }
    look_target(&v->look, target);
    ag_scene_look_at(v->desc->scene, v->look.eye, target,
                     (float)((double)v->look.fov_deg * (PI / 180.0)), &v->camera);
}

static void take_pick(struct viewer *v)
{
    struct ag_pick pick;
    if (ag_renderer_picked(v->main.renderer, &pick) != AG_OK || pick.frame == 0 ||
        pick.x != v->pick_at[0] || pick.y != v->pick_at[1])
        return;
    v->picked_instance = pick.instance;
    v->picking = false;
}

// Light that a thread makes, as that of objects in drt, comes with a later frame, and settles from
// then on.
static void count_frame(struct viewer *v)
{
    const bool updating = ag_renderer_is_updating(v->main.renderer) ||
                          (v->split && ag_renderer_is_updating(v->other.renderer));
    if (v->updating && !updating) viewer_touch(v);
    v->updating = updating;
    if (v->dirty > (updating ? 1 : 0)) v->dirty--;
}

static bool render(struct viewer *v)
{
    struct ag_frame_desc frame;
    const int mouse[2] = { (int)(v->scale * v->mouse_x), (int)(v->scale * v->mouse_y) };
    update_camera(v);
    ag_frame_desc_default(&frame);
    frame.camera = v->camera;
    frame.time_s = v->time_s;
    frame.animation = v->desc->animation;
    frame.auto_exposure = v->auto_exposure;
    frame.exposure_ev = v->exposure_ev;
    if (v->pick_at[0] >= v->main.width || v->pick_at[1] >= v->main.height) v->picking = false;
    if (v->picking)
        frame.pick = v->pick_at;
    else if (mouse[0] >= 0 && mouse[1] >= 0 && mouse[0] < v->main.width &&
             mouse[1] < v->main.height)
        frame.pick = mouse;
    enum ag_result result = rendering_render(&v->main, &frame);
    if (result == AG_OK && v->split) {
        // Both are exposed alike.
        frame.pick = NULL;
        if (v->auto_exposure) {
            struct ag_finished_frame finished;
            ag_renderer_finished(v->main.renderer, &finished);
            frame.auto_exposure = finished.frame == 0;
            frame.exposure_ev = finished.exposure_ev;
        }
        result = rendering_render(&v->other, &frame);
    }
    if (v->picking) take_pick(v);
    count_frame(v);
    times_add(v);
    return viewer_check(v, result);
}

static bool fit(struct viewer *v, struct rendering *rendering, int width, int height)
{
    if (width == rendering->width && height == rendering->height) return true;
    viewer_change(v);
    return viewer_check(v, rendering_resize(rendering, width, height));
}

static bool fit_renderings(struct viewer *v)
{
    int width, height;
    viewer_image_size(v, &width, &height);
    return fit(v, &v->main, width, height) && (!v->split || fit(v, &v->other, width, height));
}

static void draw_renderings(struct viewer *v)
{
    const struct region r = viewer_region(v);
    const bool side = viewer_is_side_by_side(v);
    const float by = side ? r.x1 - r.x0 : 0.0f, first = viewer_first_share(v);
    const float rectangle[4] = { r.x0, r.y0, r.x1, r.y1 };
    const float second[4] = { r.x0 + by, r.y0, r.x1 + by, r.y1 };
    const float from = side ? 0.0f : first;
    swapchain_clear(&v->swapchain);
    rendering_draw(&v->main, &v->swapchain, rectangle, 0.0f, first);
    if (v->truth) host_image_draw(&v->truth_image, &v->swapchain, second, from, 1.0f);
    if (v->split) rendering_draw(&v->other, &v->swapchain, second, from, 1.0f);
}

// ---- the window

static bool write_screenshot(struct viewer *v, const struct gpu_mapped *mapped, const char *path)
{
    const int width = (int)v->swapchain.width, height = (int)v->swapchain.height;
    const bool bgr = v->swapchain.format.format == VK_FORMAT_B8G8R8A8_UNORM;
    const unsigned char *bytes = mapped->bytes;
    struct ag_image *image = NULL;
    enum ag_result result = ag_image_create(v->desc->context, width, height, 3, &image);
    for (int i = 0; result == AG_OK && i < width * height; i++)
        for (int c = 0; c < 3; c++)
            image->pixels[3 * i + c] = srgb_linear(bytes[4 * i + (bgr ? 2 - c : c)]);
    if (result == AG_OK) result = ag_image_write_png(v->desc->context, path, image);
    ag_image_destroy(v->desc->context, image);
    return viewer_check(v, result);
}

static bool draw(struct viewer *v)
{
    VkCommandBuffer commands;
    struct gpu_mapped copy = { 0 };
    bool alive = swapchain_begin(&v->swapchain, &commands);
    const bool copies =
        alive && commands && v->screenshot[0] &&
        gpu_mapped_open(&v->gpu, (VkDeviceSize)v->swapchain.width * v->swapchain.height * 4, &copy);
    if (!commands) {
        interface_skip();
        return alive;
    }
    draw_renderings(v);
    swapchain_pass_begin(&v->swapchain);
    interface_end(commands);
    swapchain_pass_end(&v->swapchain);
    if (copies) swapchain_copy(&v->swapchain, copy.buffer);
    alive = swapchain_end(&v->swapchain);
    if (copies) {
        alive = vkQueueWaitIdle(v->gpu.queue) == VK_SUCCESS && alive;
        if (alive && !write_screenshot(v, &copy, v->screenshot)) v->screenshot_failed = true;
        v->screenshot[0] = 0;
        gpu_mapped_close(&v->gpu, &copy);
    }
    return alive;
}

static bool fit_window(struct viewer *v)
{
    int width, height;
    window_pixels(v->window, &width, &height);
    if (width == 0 || height == 0) return true;
    if (!v->swapchain.stale && (uint32_t)width == v->swapchain.width &&
        (uint32_t)height == v->swapchain.height)
        return true;
    return swapchain_resize(&v->swapchain, width, height);
}

// Minimised: nobody sees the frames of animations and fading histories. A recorded flight goes on.
static bool is_hidden(const struct viewer *v)
{
    int width, height;
    if (v->script || v->desc->frames > 0 || v->record.runs) return false;
    window_pixels(v->window, &width, &height);
    return width == 0 || height == 0 || !v->swapchain.handle;
}

static bool is_idle(const struct viewer *v)
{
    if (v->script) return script_waits(v->script, v);
    if (is_hidden(v)) return true;
    return v->dirty == 0 && !v->opening[0] && !v->playing && v->desc->frames == 0 && !v->turning;
}

static void handle_events(struct viewer *v, bool waits)
{
    struct event_queue queue = { .count = 0 };
    window_poll(v->window, waits ? IDLE_WAIT_S : 0.0, &queue);
    if (v->script) queue.count = 0; // a script alone has the window
    if (v->script && !script_step(v->script, v, &queue)) v->quit = true;
    for (int i = 0; i < queue.count; i++) {
        interface_event(&queue.events[i]);
        controls_event(v, &queue.events[i]);
    }
}

static bool is_last(const struct viewer *v)
{
    return v->quit || (v->desc->frames > 0 && v->frame + 1 == (uint64_t)v->desc->frames);
}

static void open_next(struct viewer *v)
{
    char why[512];
    v->next = v->desc->open_scene(v->desc->user, v->opening, v->gi, why);
    if (!v->next) viewer_warn(v, "%s", why);
    v->opening[0] = 0;
}

bool frame_step(struct viewer *v, float seconds)
{
    if (v->opening[0] && v->opening_said) open_next(v);
    if (v->next) return true;
    v->opening_said = v->opening[0];
    handle_events(v, is_idle(v));
    if (v->desc->screenshot && is_last(v))
        snprintf(v->screenshot, sizeof v->screenshot, "%s", v->desc->screenshot);
    controls_step(v, seconds);
    record_place(v);
    if (v->playing && !v->record.runs) v->time_s += (double)seconds;
    if (v->playing) viewer_change(v);
    if (!fit_window(v)) return false;
    if (is_hidden(v)) {
        running_step(v);
        return true;
    }
    const bool shown = v->swapchain.handle != VK_NULL_HANDLE;
    if (shown && fit_renderings(v) && (v->dirty > 0 || v->playing) && render(v)) record_take(v);
    running_step(v);
    paint_step(v);
    if (!shown) return true;
    interface_begin((int)v->swapchain.width, (int)v->swapchain.height, seconds);
    panels_draw(v);
    undo_step(v, interface_is_held() || v->gizmo.held || v->paint.stroke);
    return draw(v);
}
