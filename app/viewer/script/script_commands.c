// Commands of scripts that are no input.
#include "script_state.h"

#include "viewer/command.h"
#include "viewer/scene/opening.h"
#include "viewer/operations.h"
#include "viewer/methods/running.h"
#include "viewer/scene/session_file.h"
#include "viewer/scene/undo.h"
#include "shell/json_values.h"
#include "viewer/methods/tone.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool run_wait(const struct words *w)
{
    w->script->waits = atoi(w->rest);
    return true;
}

static bool run_settle(const struct words *w)
{
    w->script->settle_frames = atoi(w->rest);
    return w->script->settles = true;
}

static bool run_gi(const struct words *w)
{
    return script_done(w, viewer_set_gi(w->v, w->rest));
}

static bool run_side(const struct words *w)
{
    viewer_set_side_by_side(w->v, strcmp(w->rest, "on") == 0);
    return true;
}

static bool run_undo(const struct words *w)
{
    return script_done(w, undo_back(w->v));
}

static bool run_redo(const struct words *w)
{
    return script_done(w, undo_forward(w->v));
}

static bool run_save(const struct words *w)
{
    return script_done(w, viewer_write(w->v, w->rest));
}

static bool run_lose(const struct words *w)
{
    return w->v->swapchain.loses_device = true;
}

static bool run_quit(const struct words *w)
{
    return w->v->quit = true;
}

static bool run_choose(const struct words *w)
{
    int index = -1;
    if (sscanf(w->rest, "light %d", &index) == 1)
        w->v->gizmo.light = index;
    else if (sscanf(w->rest, "instance %d", &index) == 1)
        w->v->picked_instance = index;
    else
        return script_wrong(w->script, "choose takes light N or instance N:", w->rest);
    return true;
}

static bool run_tab(const struct words *w)
{
    static const char *const tabs[] = { "View", "Light", "Method", "Compare", "Cost", "Inspect" };
    for (int i = 0; i < (int)(sizeof tabs / sizeof *tabs); i++)
        if (strcmp(tabs[i], w->rest) == 0) {
            w->v->show_tab = i;
            w->script->waits = 2;
            return true;
        }
    return script_wrong(w->script, "unknown tab", w->rest);
}

static bool run_size(const struct words *w)
{
    int width, height;
    if (sscanf(w->rest, "%dx%d", &width, &height) != 2 || width < 1 || height < 1 ||
        width > 16384 || height > 16384)
        return script_wrong(w->script, "a size is WxH:", w->rest);
    window_resize(w->v->window, width, height);
    return true;
}

static bool run_split(const struct words *w)
{
    struct viewer *v = w->v;
    const bool reference = strcmp(w->rest, "reference") == 0;
    const bool off = strcmp(w->rest, "off") == 0;
    if (reference) return script_done(w, viewer_set_reference(v, true));
    if (!off) return script_done(w, viewer_set_split(v, w->rest));
    return script_done(w, viewer_set_reference(v, false) && viewer_set_split(v, NULL));
}

static bool run_samples(const struct words *w)
{
    w->script->samples = atoi(w->rest);
    if (w->script->samples < 1 || w->script->samples > TRUTH_SAMPLES)
        return script_wrong(w->script, "samples are 1 to 4096:", w->rest);
    return w->v->truth || script_wrong(w->script, "the reference is not shown:", "split reference");
}

static bool run_layer(const struct words *w)
{
    for (int i = 0; i < viewer_layer_count; i++)
        if (strcmp(viewer_layers[i], w->rest) == 0) {
            viewer_set_layer(w->v, i);
            return true;
        }
    return script_wrong(w->script, "unknown layer", w->rest);
}

static bool run_exposure(const struct words *w)
{
    const int metering = viewer_metering_of(w->rest);
    w->v->auto_exposure = metering >= 0 || strcmp(w->rest, "auto") == 0;
    if (metering >= 0 && !script_done(w, viewer_set_metering(w->v, (enum ag_metering)metering)))
        return false;
    if (!w->v->auto_exposure) w->v->exposure_ev = strtof(w->rest, NULL);
    viewer_change(w->v);
    return true;
}

static bool run_tonemap(const struct words *w)
{
    const int curve = viewer_curve_of(w->rest);
    if (curve < 0) return script_wrong(w->script, "tone curve is neutral, agx or linear:", w->rest);
    return script_done(w, viewer_set_tonemap(w->v, (enum ag_tonemap)curve));
}

static bool run_scale(const struct words *w)
{
    const float scale = strtof(w->rest, NULL);
    if (!(scale >= 0.1f && scale <= 2.0f))
        return script_wrong(w->script, "scale is 0.1 to 2:", w->rest);
    w->v->scale = scale;
    viewer_change(w->v);
    return true;
}

static bool run_camera(const struct words *w)
{
    const struct ag_scene *scene = w->v->desc->scene;
    const int count = ag_scene_camera_count(scene);
    for (int i = 0; i < count; i++)
        if (strcmp(ag_scene_camera_name(scene, i), w->rest) == 0) {
            viewer_set_camera(w->v, i);
            return true;
        }
    if (strcmp(w->rest, "given") != 0) return script_wrong(w->script, "unknown camera", w->rest);
    viewer_set_camera(w->v, -1);
    return true;
}

static bool run_look(const struct words *w)
{
    struct ag_camera camera = w->v->camera;
    float *e = camera.eye, *t = camera.target;
    if (sscanf(w->rest, "%f,%f,%f %f,%f,%f", e, e + 1, e + 2, t, t + 1, t + 2) != 6)
        return script_wrong(w->script, "look takes X,Y,Z X,Y,Z:", w->rest);
    for (int i = 0; i < 3; i++)
        if (!isfinite(e[i]) || !isfinite(t[i]))
            return script_wrong(w->script, "look takes finite numbers:", w->rest);
    const float speed = w->v->look.speed;
    look_from_camera(&w->v->look, &camera, 0);
    w->v->look.speed = speed;
    w->v->look.moved = true;
    viewer_change(w->v);
    return true;
}

static bool run_path(const struct words *w)
{
    struct viewer *v = w->v;
    if (strcmp(w->rest, "add") == 0)
        return path_add(&v->path, &v->look) || script_wrong(w->script, "the path is full", "");
    float seconds;
    int fps;
    if (sscanf(w->rest, "every %f %d", &seconds, &fps) == 2) {
        if (!(seconds >= 0.01f && seconds <= 1e4f) || fps < 1 || fps > 240)
            return script_wrong(w->script,
                                "0.01 to 10000 s and 1 to 240 images are expected:", w->rest);
        v->path.seconds = seconds;
        v->path.fps = fps;
        return true;
    }
    if (strncmp(w->rest, "record ", 7) != 0)
        return script_wrong(w->script, "path takes add, every S FPS or record FOLDER:", w->rest);
    snprintf(v->record.folder, sizeof v->record.folder, "%s", w->rest + 7);
    w->script->records = record_begin(v);
    return script_done(w, w->script->records);
}

static bool run_open(const struct words *w)
{
    return script_done(w, viewer_open(w->v, w->rest));
}

static bool run_session(const struct words *w)
{
    if (strncmp(w->rest, "write ", 6) == 0)
        return script_done(w, session_file_write(w->v, w->rest + 6));
    if (strncmp(w->rest, "read ", 5) == 0)
        return script_done(w, session_file_read(w->v, w->rest + 5));
    return script_wrong(w->script, "session takes write FILE or read FILE:", w->rest);
}

static bool run_command(const struct words *w)
{
    char command[METHOD_SPEC];
    if (!viewer_command(w->v, command, sizeof command - 1)) return script_done(w, false);
    strcat(command, "\n"); // viewer_command leaves room
    return script_done(w, viewer_write_text(w->v, w->rest, command));
}

static bool run_errors(const struct words *w)
{
    struct truth_state state = { 0 };
    if (w->v->truth) truth_get(w->v->truth, &state);
    if (!state.measured || !w->v->offered)
        return script_wrong(w->script, "no errors are measured: use samples N", "");
    return script_done(w,
                       viewer_write_json(w->v, w->rest,
                                         json_pack("{s:i, s:o, s:o, s:o}", "samples", state.samples,
                                                   "flip", json_double(state.flip), "relmse",
                                                   json_double(state.relative_error), "energy",
                                                   json_double(state.energy)),
                                         0));
}

static bool run_pace(const struct words *w)
{
    struct pace_summary pace;
    pace_get(&w->v->pace, &pace);
    pace_clear(&w->v->pace);
    if (strcmp(w->rest, "clear") == 0) return true;
    return script_done(
        w, viewer_write_json(w->v, w->rest,
                             json_pack("{s:i, s:o, s:o, s:o}", "frames", pace.frames, "mean_ms",
                                       json_float(pace.mean_ms), "p95_ms", json_float(pace.p95_ms),
                                       "most_ms", json_float(pace.most_ms)),
                             0));
}

static bool run_inspect(const struct words *w)
{
    struct viewer *v = w->v;
    struct pixel_at at;
    struct pixel pixel;
    if (!pixel_chosen(v, &at)) return script_wrong(w->script, "the mouse is not in the image", "");
    if (!pixels_read(v, at.other) || !pixel_get(v, &at, &pixel))
        return script_wrong(w->script, "the image has not settled: use settle", "");
    return script_done(w, viewer_write_json(v, w->rest, pixel_json(&at, &pixel), 0));
}

static bool run_screenshot(const struct words *w)
{
    snprintf(w->v->screenshot, sizeof w->v->screenshot, "%s", w->rest);
    w->script->waits = 1;
    return true;
}

const struct script_command script_commands[] = {
    { "wait", false, run_wait },
    { "settle", false, run_settle },
    { "gi", false, run_gi },
    { "side", false, run_side },
    { "undo", false, run_undo },
    { "redo", false, run_redo },
    { "save", false, run_save },
    { "lose", false, run_lose },
    { "quit", false, run_quit },
    { "choose", false, run_choose },
    { "tab", false, run_tab },
    { "size", false, run_size },
    { "split", false, run_split },
    { "samples", false, run_samples },
    { "layer", false, run_layer },
    { "exposure", false, run_exposure },
    { "tonemap", false, run_tonemap },
    { "scale", false, run_scale },
    { "camera", false, run_camera },
    { "look", false, run_look },
    { "light", false, script_light },
    { "environment", false, script_environment },
    { "paint", false, script_paint },
    { "blocks", false, script_blocks },
    { "path", false, run_path },
    { "open", false, run_open },
    { "session", false, run_session },
    { "command", false, run_command },
    { "errors", false, run_errors },
    { "pace", false, run_pace },
    { "inspect", false, run_inspect },
    { "memory", false, script_run_memory },
    { "screenshot", false, run_screenshot },
    { NULL, false, NULL },
};
