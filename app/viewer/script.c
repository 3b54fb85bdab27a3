#include "script.h"

#include "viewer/methods/bakes.h"
#include "viewer/scene/changes.h"
#include "command.h"
#include "viewer/scene/opening.h"
#include "operations.h"
#include "viewer/methods/running.h"
#include "viewer/scene/session_file.h"
#include "viewer/scene/undo.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_SIZE = 4096 };

struct script {
    FILE *file;
    const char *path;
    int line;
    char text[LINE_SIZE]; // the next line; "": to be read
    int waits;            // further frames
    bool settles;         // until the image is complete
    int samples;          // until the reference has N; 0: none
    float click_x, click_y;
    int click;            // steps of a click that are left: down, up
    float drag_x, drag_y; // of the mouse in between
    uint64_t random;
    int random_left;
    char error[1024]; // "": none
};

struct script *script_open(const char *path, char error[1024])
{
    struct script *script = calloc(1, sizeof *script);
    FILE *file = script ? fopen(path, "r") : NULL;
    if (!file) {
        snprintf(error, 1024, "cannot read %s: %s", path, script ? strerror(errno) : "no memory");
        free(script);
        return NULL;
    }
    script->file = file;
    script->path = path;
    return script;
}

void script_close(struct script *script)
{
    if (!script) return;
    fclose(script->file);
    free(script);
}

bool script_failed(const struct script *script, char error[1024])
{
    if (script->error[0]) snprintf(error, 1024, "%s", script->error);
    return script->error[0] != 0;
}

bool script_waits(const struct script *script, const struct viewer *v)
{
    return v->dirty == 0 && (script->samples > 0 || (script->settles && bakes_running(v)));
}

static bool wrong(struct script *script, const char *what, const char *text)
{
    snprintf(script->error, sizeof script->error, "%.250s:%d: %.350s%s%.350s", script->path,
             script->line, what, text[0] ? " " : "", text);
    return false;
}

// ---- commands: false after a failure

struct words {
    struct viewer *v;
    struct script *script;
    struct event_queue *queue;
    const char *name;
    char *rest; // of the line, after the name
};

static bool is(const struct words *w, const char *name)
{
    return strcmp(w->name, name) == 0;
}

static bool done(const struct words *w, bool success)
{
    return success || wrong(w->script, w->v->message, "");
}

static bool run_mouse(const struct words *w)
{
    struct event event = { .kind = is(w, "mouse") ? EVENT_MOUSE : EVENT_SCROLL };
    if (sscanf(w->rest, "%f %f", &event.x, &event.y) != 2)
        return wrong(w->script, "two numbers expected:", w->rest);
    event_push(w->queue, &event);
    return true;
}

static bool run_button(const struct words *w)
{
    static const char *const buttons[] = { "left", "right", "middle" };
    char name[16] = "", state[16] = "";
    struct event event = { .kind = EVENT_BUTTON, .code = -1 };
    sscanf(w->rest, "%15s %15s", name, state);
    for (int i = 0; i < 3; i++)
        if (strcmp(name, buttons[i]) == 0) event.code = i;
    event.down = strcmp(state, "down") == 0;
    if (event.code < 0) return wrong(w->script, "unknown button", name);
    event_push(w->queue, &event);
    return true;
}

static bool run_key(const struct words *w)
{
    char name[32] = "", state[16] = "";
    sscanf(w->rest, "%31s %15s", name, state);
    struct event event = { .kind = EVENT_KEY, .code = event_key_code(name) };
    if (!event.code) return wrong(w->script, "unknown key", name);
    event.down = is(w, "press") || strcmp(state, "down") == 0;
    event_push(w->queue, &event);
    if (!is(w, "press")) return true;
    event.down = false;
    event_push(w->queue, &event);
    return true;
}

static bool run_text(const struct words *w)
{
    for (const char *c = w->rest; *c; c++)
        event_push(w->queue, &(struct event){ .kind = EVENT_TEXT, .code = (unsigned char)*c });
    return true;
}

static bool run_click(const struct words *w)
{
    struct script *script = w->script;
    if (!interface_find(w->rest, &script->click_x, &script->click_y))
        return wrong(script, "no element is shown with the label", w->rest);
    event_push(w->queue,
               &(struct event){ .kind = EVENT_MOUSE, .x = script->click_x, .y = script->click_y });
    script->click = 2;
    script->drag_x = script->drag_y = 0;
    return true;
}

static bool run_choose(const struct words *w)
{
    int index = -1;
    if (sscanf(w->rest, "light %d", &index) == 1)
        w->v->gizmo.light = index;
    else if (sscanf(w->rest, "instance %d", &index) == 1)
        w->v->picked_instance = index;
    else
        return wrong(w->script, "choose takes light N or instance N:", w->rest);
    return true;
}

static bool run_drag(const struct words *w)
{
    struct script *script = w->script;
    char name[8];
    if (sscanf(w->rest, "%7s %f %f", name, &script->drag_x, &script->drag_y) != 3)
        return wrong(script, "drag takes x|y|z|turn DX DY:", w->rest);
    for (int i = 0; i < HANDLE_COUNT; i++)
        if (strcmp(name, gizmo_handles[i]) == 0 &&
            gizmo_find(w->v, (enum gizmo_handle)i, &script->click_x, &script->click_y)) {
            event_push(
                w->queue,
                &(struct event){ .kind = EVENT_MOUSE, .x = script->click_x, .y = script->click_y });
            script->waits = 1; // the panels let go of the mouse
            script->click = 2;
            return true;
        }
    return wrong(script, "no handle is shown with the name", name);
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
    return wrong(w->script, "unknown tab", w->rest);
}

static bool run_size(const struct words *w)
{
    int width, height;
    if (sscanf(w->rest, "%dx%d", &width, &height) != 2 || width < 1 || height < 1 ||
        width > 16384 || height > 16384)
        return wrong(w->script, "a size is WxH:", w->rest);
    window_resize(w->v->window, width, height);
    return true;
}

static bool run_split(const struct words *w)
{
    struct viewer *v = w->v;
    const bool reference = strcmp(w->rest, "reference") == 0;
    const bool off = strcmp(w->rest, "off") == 0;
    if (reference) return done(w, viewer_set_reference(v, true));
    if (!off) return done(w, viewer_set_split(v, w->rest));
    return done(w, viewer_set_reference(v, false) && viewer_set_split(v, NULL));
}

static bool run_samples(const struct words *w)
{
    w->script->samples = atoi(w->rest);
    if (w->script->samples < 1 || w->script->samples > TRUTH_SAMPLES)
        return wrong(w->script, "samples are 1 to 4096:", w->rest);
    return w->v->truth || wrong(w->script, "the reference is not shown:", "split reference");
}

static bool run_layer(const struct words *w)
{
    for (int i = 0; i < viewer_layer_count; i++)
        if (strcmp(viewer_layers[i], w->rest) == 0) {
            viewer_set_layer(w->v, i);
            return true;
        }
    return wrong(w->script, "unknown layer", w->rest);
}

static bool run_exposure(const struct words *w)
{
    w->v->auto_exposure = strcmp(w->rest, "auto") == 0;
    if (!w->v->auto_exposure) w->v->exposure_ev = strtof(w->rest, NULL);
    viewer_change(w->v);
    return true;
}

static bool run_scale(const struct words *w)
{
    const float scale = strtof(w->rest, NULL);
    if (!(scale >= 0.1f && scale <= 2.0f)) return wrong(w->script, "scale is 0.1 to 2:", w->rest);
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
    if (strcmp(w->rest, "given") != 0) return wrong(w->script, "unknown camera", w->rest);
    viewer_set_camera(w->v, -1);
    return true;
}

static bool run_look(const struct words *w)
{
    struct ag_camera camera = w->v->camera;
    float *e = camera.eye, *t = camera.target;
    if (sscanf(w->rest, "%f,%f,%f %f,%f,%f", e, e + 1, e + 2, t, t + 1, t + 2) != 6)
        return wrong(w->script, "look takes X,Y,Z X,Y,Z:", w->rest);
    const float speed = w->v->look.speed;
    look_from_camera(&w->v->look, &camera, 0);
    w->v->look.speed = speed;
    w->v->look.moved = true;
    viewer_change(w->v);
    return true;
}

static bool run_light(const struct words *w)
{
    int light = -1, on = 0;
    struct ag_light_info info;
    sscanf(w->rest, "%d %d", &light, &on);
    if (!viewer_check(w->v, ag_scene_get_light(w->v->desc->scene, light, w->v->desc->animation,
                                               w->v->time_s, &info)))
        return done(w, false);
    info.light.enabled = on != 0;
    return done(w, viewer_set_light(w->v, light, &info.light));
}

static bool run_path(const struct words *w)
{
    struct viewer *v = w->v;
    if (strcmp(w->rest, "add") == 0)
        return path_add(&v->path, &v->look) || wrong(w->script, "the path is full", "");
    float seconds;
    int fps;
    if (sscanf(w->rest, "every %f %d", &seconds, &fps) == 2) {
        if (!(seconds >= 0.01f && seconds <= 1e4f) || fps < 1 || fps > 240)
            return wrong(w->script, "0.01 to 10000 s and 1 to 240 images are expected:", w->rest);
        v->path.seconds = seconds;
        v->path.fps = fps;
        return true;
    }
    if (strncmp(w->rest, "record ", 7) != 0)
        return wrong(w->script, "path takes add, every S FPS or record FOLDER:", w->rest);
    snprintf(v->record.folder, sizeof v->record.folder, "%s", w->rest + 7);
    return done(w, record_begin(v));
}

static bool run_open(const struct words *w)
{
    return done(w, viewer_open(w->v, w->rest));
}

static bool run_drop(const struct words *w)
{
    struct event event = { .kind = EVENT_DROP };
    snprintf(event.text, sizeof event.text, "%s", w->rest);
    event_push(w->queue, &event);
    w->script->waits = 1;
    return true;
}

static bool run_session(const struct words *w)
{
    if (strncmp(w->rest, "write ", 6) == 0) return done(w, session_file_write(w->v, w->rest + 6));
    if (strncmp(w->rest, "read ", 5) == 0) return done(w, session_file_read(w->v, w->rest + 5));
    return wrong(w->script, "session takes write FILE or read FILE:", w->rest);
}

static bool run_command(const struct words *w)
{
    char command[METHOD_SPEC];
    if (!viewer_command(w->v, command, sizeof command - 1)) return done(w, false);
    strcat(command, "\n"); // viewer_command leaves room
    return done(w, viewer_write_text(w->v, w->rest, command));
}

static bool run_errors(const struct words *w)
{
    struct truth_state state = { 0 };
    char text[256];
    if (w->v->truth) truth_get(w->v->truth, &state);
    if (!state.measured || !w->v->offered)
        return wrong(w->script, "no errors are measured: use samples N", "");
    snprintf(text, sizeof text,
             "{\"samples\": %d, \"flip\": %.9g, \"relmse\": %.9g, \"energy\": %.9g}\n",
             state.samples, state.flip, state.relative_error, state.energy);
    return done(w, viewer_write_text(w->v, w->rest, text));
}

static bool run_pace(const struct words *w)
{
    struct pace_summary pace;
    char text[256];
    pace_get(&w->v->pace, &pace);
    pace_clear(&w->v->pace);
    if (strcmp(w->rest, "clear") == 0) return true;
    snprintf(text, sizeof text,
             "{\"frames\": %d, \"mean_ms\": %.4g, \"p95_ms\": %.4g, \"most_ms\": %.4g}\n",
             pace.frames, (double)pace.mean_ms, (double)pace.p95_ms, (double)pace.most_ms);
    return done(w, viewer_write_text(w->v, w->rest, text));
}

static bool run_inspect(const struct words *w)
{
    struct viewer *v = w->v;
    struct pixel_at at;
    struct pixel pixel;
    char text[4096];
    if (!pixel_chosen(v, &at)) return wrong(w->script, "the mouse is not in the image", "");
    if (!pixels_read(v, at.other) || !pixel_get(v, &at, &pixel))
        return wrong(w->script, "the image has not settled: use settle", "");
    if (!pixel_print(&at, &pixel, text, sizeof text))
        return wrong(w->script, "a name of the scene is too long", "");
    return done(w, viewer_write_text(v, w->rest, text));
}

static bool run_screenshot(const struct words *w)
{
    snprintf(w->v->screenshot, sizeof w->v->screenshot, "%s", w->rest);
    w->script->waits = 1;
    return true;
}

static bool run_random(const struct words *w)
{
    unsigned long seed = 0;
    if (sscanf(w->rest, "%lu %d", &seed, &w->script->random_left) != 2)
        return wrong(w->script, "random takes SEED N:", w->rest);
    w->script->random = seed * 0x9e3779b97f4a7c15u + 1;
    return true;
}

static bool run(const struct words *w)
{
    struct viewer *v = w->v;
    if (is(w, "wait")) {
        w->script->waits = atoi(w->rest);
        return true;
    }
    if (is(w, "settle")) return w->script->settles = true;
    if (is(w, "mouse") || is(w, "scroll")) return run_mouse(w);
    if (is(w, "button")) return run_button(w);
    if (is(w, "key") || is(w, "press")) return run_key(w);
    if (is(w, "text")) return run_text(w);
    if (is(w, "click")) return run_click(w);
    if (is(w, "tab")) return run_tab(w);
    if (is(w, "size")) return run_size(w);
    if (is(w, "gi")) return done(w, viewer_set_gi(v, w->rest));
    if (is(w, "split")) return run_split(w);
    if (is(w, "side")) {
        viewer_set_side_by_side(v, strcmp(w->rest, "on") == 0);
        return true;
    }
    if (is(w, "samples")) return run_samples(w);
    if (is(w, "layer")) return run_layer(w);
    if (is(w, "exposure")) return run_exposure(w);
    if (is(w, "scale")) return run_scale(w);
    if (is(w, "camera")) return run_camera(w);
    if (is(w, "look")) return run_look(w);
    if (is(w, "light")) return run_light(w);
    if (is(w, "undo")) return done(w, undo_back(v));
    if (is(w, "redo")) return done(w, undo_forward(v));
    if (is(w, "session")) return run_session(w);
    if (is(w, "choose")) return run_choose(w);
    if (is(w, "drag")) return run_drag(w);
    if (is(w, "path")) return run_path(w);
    if (is(w, "open")) return run_open(w);
    if (is(w, "drop")) return run_drop(w);
    if (is(w, "save")) return done(w, viewer_write(v, w->rest));
    if (is(w, "screenshot")) return run_screenshot(w);
    if (is(w, "command")) return run_command(w);
    if (is(w, "errors")) return run_errors(w);
    if (is(w, "lose")) return v->swapchain.loses_device = true;
    if (is(w, "pace")) return run_pace(w);
    if (is(w, "inspect")) return run_inspect(w);
    if (is(w, "random")) return run_random(w);
    if (is(w, "quit")) return v->quit = true;
    return wrong(w->script, "unknown command", w->name);
}

// ---- random events

static uint32_t draw(struct script *script, uint32_t below)
{
    script->random = script->random * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(script->random >> 33) % below;
}

static void push_random(struct script *script, struct viewer *v, struct event_queue *queue)
{
    static const char *const names[] = { "w",      "a",    "s",    "d",     "q",
                                         "e",      "f",    "tab",  "enter", "space",
                                         "escape", "home", "down", "up",    "backspace" };
    struct event event = { .kind = EVENT_MOUSE };
    switch (draw(script, 8)) {
    case 0:
    case 1:
    case 2:
        event.x = (float)draw(script, v->swapchain.width + 1);
        event.y = (float)draw(script, v->swapchain.height + 1);
        break;
    case 3:
    case 4:
    case 5:
        event.kind = EVENT_BUTTON;
        event.code = draw(script, 8) ? 0 : (int)draw(script, 3);
        event.down = draw(script, 2);
        break;
    case 6:
        event.kind = EVENT_KEY;
        event.code = event_key_code(names[draw(script, sizeof names / sizeof *names)]);
        event.down = draw(script, 2);
        break;
    case 7:
        event.kind = draw(script, 2) ? EVENT_SCROLL : EVENT_TEXT;
        event.y = (float)draw(script, 5) - 2.0f;
        event.code = (int)draw(script, 95) + 32;
        break;
    default:
        break;
    }
    event_push(queue, &event);
}

// ---- lines

static bool read_line(struct script *script, char line[LINE_SIZE])
{
    while (fgets(line, LINE_SIZE, script->file)) {
        script->line++;
        line[strcspn(line, "\r\n#")] = 0;
        size_t length = strlen(line);
        while (length > 0 && line[length - 1] == ' ') line[--length] = 0;
        if (line[strspn(line, " \t")]) return true;
    }
    return false;
}

static bool run_line(struct script *script, struct viewer *v, struct event_queue *queue,
                     char *line);

static bool run_says(const struct words *w)
{
    return strstr(w->v->message, w->rest) ||
           wrong(w->script, "the status line has no such text, but:", w->v->message);
}

// The rest of the line must fail; its sentence goes to the status line.
static bool run_fails(const struct words *w)
{
    struct script *script = w->script;
    if (run_line(script, w->v, w->queue, w->rest))
        return wrong(script, "the line did not fail:", w->name);
    if (script->error[0]) viewer_warn(w->v, "%s", script->error);
    script->error[0] = 0;
    return true;
}

static bool run_line(struct script *script, struct viewer *v, struct event_queue *queue, char *line)
{
    char *name = line + strspn(line, " \t"), *rest = name + strcspn(name, " \t");
    if (*rest) *rest++ = 0;
    rest += strspn(rest, " \t");
    const struct words w = { v, script, queue, name, rest };
    if (is(&w, "fails")) return run_fails(&w);
    return is(&w, "says") ? run_says(&w) : run(&w);
}

static bool lacks_samples(struct script *script, struct viewer *v)
{
    struct truth_state state = { 0 };
    if (script->samples == 0 || !v->truth) return false;
    truth_get(v->truth, &state);
    if (state.error[0]) wrong(script, state.error, "");
    if (state.samples >= script->samples && state.measured && v->offered) script->samples = 0;
    return script->samples > 0;
}

// A line goes on for further frames.
static bool goes_on(struct script *script, struct viewer *v, struct event_queue *queue)
{
    if (script->waits > 0) {
        script->waits--;
        return true;
    }
    if (script->click > 0) {
        if (script->click == 1)
            event_push(queue, &(struct event){ .kind = EVENT_MOUSE,
                                               .x = script->click_x + script->drag_x,
                                               .y = script->click_y + script->drag_y });
        event_push(queue, &(struct event){ .kind = EVENT_BUTTON, .down = script->click == 2 });
        script->click--;
        return true;
    }
    if (script->random_left > 0) {
        script->random_left--;
        push_random(script, v, queue);
        return true;
    }
    if (v->screenshot[0]) return true;         // the window had no image
    if (v->record.runs) return true;           // until the last image is written
    if (v->opening[0] || v->next) return true; // until the scene is there
    script->settles = script->settles && (v->dirty > 0 || bakes_running(v));
    return script->settles || lacks_samples(script, v);
}

// Other commands wait for the events of the lines before.
static bool is_event(const char *line)
{
    static const char *const names[] = { "mouse", "button", "scroll", "key", "press", "text" };
    line += strspn(line, " \t");
    for (int i = 0; i < (int)(sizeof names / sizeof *names); i++) {
        const size_t length = strlen(names[i]);
        if (strncmp(line, names[i], length) == 0 && strchr(" \t", line[length])) return true;
    }
    return false;
}

bool script_step(struct script *script, struct viewer *v, struct event_queue *queue)
{
    if (v->screenshot_failed || v->record.failed) return wrong(script, v->message, "");
    while (!goes_on(script, v, queue)) {
        if (!script->text[0] && !read_line(script, script->text)) return false;
        if (queue->count > 0 && !is_event(script->text)) return true;
        if (!run_line(script, v, queue, script->text)) return false;
        script->text[0] = 0;
    }
    return !script->error[0]; // the reference failed
}
