#include "running.h"

#include "bakes.h"
#include "tone.h"
#include "viewer/operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- methods

static bool open_rendering(struct viewer *v, const char *gi, struct rendering *out)
{
    struct rendering_desc desc = { .gpu = &v->gpu,
                                   .context = v->desc->context,
                                   .device = v->device,
                                   .scene = v->desc->scene,
                                   .gi = gi,
                                   .frame_options = viewer_frame_options(v) };
    viewer_image_size(v, &desc.width, &desc.height);
    const enum ag_result result = rendering_open(out, &desc);
    if (result == AG_OK && v->layer > 0)
        ag_renderer_set_display(out->renderer, viewer_layers[v->layer]);
    return viewer_check(v, result);
}

static bool needs_bake(const struct viewer *v, const char *gi)
{
    const char *technique = NULL;
    return ag_bake_technique(v->desc->context, gi, 0, &technique) == AG_OK && technique;
}

// A method that waits for its bake begins as "none".
static bool open_with(struct viewer *v, const char *gi, bool other)
{
    struct rendering *rendering = other ? &v->other : &v->main;
    const char *first = needs_bake(v, gi) ? "none" : gi;
    if (!open_rendering(v, first, rendering)) return false;
    viewer_runs(v, other, first);
    if (first != gi && bakes_set_gi(v, rendering, gi)) viewer_runs(v, other, gi);
    return true;
}

bool running_begin(struct viewer *v, const char *gi)
{
    char low[METHOD_SPEC];
    if (!v->device_info.software || v->desc->session) return open_with(v, gi, false);
    method_lower(gi, low);
    if (strcmp(low, gi) != 0)
        viewer_say(v, "a software device begins with quality=low: see the tab Method");
    return open_with(v, low, false);
}

bool viewer_set_gi(struct viewer *v, const char *gi)
{
    if (!bakes_set_gi(v, &v->main, gi)) return bakes_running(v);
    viewer_runs(v, false, gi);
    return true;
}

bool viewer_begin_gi_again(struct viewer *v, const char *gi)
{
    if (!bakes_begin_gi_again(v, &v->main, gi)) return bakes_running(v);
    viewer_runs(v, false, gi);
    return true;
}

bool viewer_set_split(struct viewer *v, const char *gi)
{
    viewer_touch(v);
    if (!gi) {
        bakes_cancel_part(v, true);
        rendering_close(&v->other);
        if (v->split) viewer_note(v, CHANGE_METHOD, -1);
        v->split = false;
        return true;
    }
    viewer_set_reference(v, false);
    if (!v->split) return v->split = open_with(v, gi, true);
    if (!bakes_set_gi(v, &v->other, gi)) return bakes_running(v);
    viewer_runs(v, true, gi);
    return true;
}

// ---- the reference

bool viewer_set_reference(struct viewer *v, bool on)
{
    if (on == (v->truth != NULL)) return true;
    if (!on) {
        truth_close(v->truth);
        host_image_close(&v->truth_image);
        v->truth = NULL;
        return true;
    }
    if (v->split) viewer_set_split(v, NULL);
    v->truth = truth_open(v->desc);
    if (!v->truth) viewer_warn(v, "cannot begin the reference: out of memory");
    viewer_change(v);
    return v->truth != NULL;
}

static void restart(struct viewer *v)
{
    const struct truth_view view = { .camera = v->camera,
                                     .width = v->main.width,
                                     .height = v->main.height,
                                     .animation = v->desc->animation,
                                     .time_s = v->time_s,
                                     .ev = viewer_exposure(v),
                                     .edits = &v->edits };
    truth_restart(v->truth, &view);
    v->changed = v->offered = false;
}

static void offer(struct viewer *v)
{
    struct ag_image *color = NULL;
    v->offered = true;
    if (viewer_check(v, ag_renderer_read(v->main.renderer, "color", &color)))
        truth_offer(v->truth, color, viewer_exposure(v));
    ag_image_destroy(v->desc->context, color);
}

static void take(struct viewer *v)
{
    struct ag_image image, *display = NULL;
    if (!truth_take(v->truth, v->difference, &image)) return;
    if (v->difference)
        host_image_set(&v->truth_image, &v->gpu, &image);
    else if (viewer_check(v, ag_image_tonemap_curve(v->desc->context, &image, viewer_exposure(v),
                                                    v->tonemap, &display)))
        host_image_set(&v->truth_image, &v->gpu, display);
    ag_image_destroy(v->desc->context, display);
    free(image.pixels);
}

void running_step(struct viewer *v)
{
    bakes_step(v);
    if (!v->truth || !v->main.shown.vk_image) return;
    // Each restart begins from nothing: the camera rests before. A software device shares its
    // processors with the reference: the image comes first.
    const int rest = v->device_info.software ? 0 : SETTLE_FRAMES - REST_FRAMES;
    if (v->changed && v->dirty > rest) truth_pause(v->truth);
    if (v->changed && v->dirty <= rest) restart(v);
    if (!v->offered && v->dirty == 0) offer(v);
    take(v);
}

void running_end(struct viewer *v)
{
    bakes_cancel(v);
    viewer_set_reference(v, false);
    rendering_close(&v->other);
    rendering_close(&v->main);
}
