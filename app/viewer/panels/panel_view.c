// Camera, exposure, layer, animation, and what is taken away.
#include "panel.h"
#include "viewer/command.h"
#include "viewer/scene/opening.h"
#include "viewer/operations.h"
#include "viewer/scene/session_file.h"
#include "viewer/methods/tone.h"

#include <stdio.h>
#include <string.h>

enum { MAX_CAMERAS = 64 };

static void choose_camera(struct viewer *v)
{
    const char *names[MAX_CAMERAS] = { "as given" };
    int count = 1, index = v->scene_camera + 1;
    const int cameras = ag_scene_camera_count(v->desc->scene);
    while (count < MAX_CAMERAS && count <= cameras) {
        names[count] = ag_scene_camera_name(v->desc->scene, count - 1);
        count++;
    }
    if (ui_choice("camera", &index, names, count)) viewer_set_camera(v, index - 1);
    ui_tooltip("Keys: W A S D, Q down, E up, shift faster. Right button: look around. Middle "
               "button, or alt and left: orbit. Wheel: nearer. F: focus on what was clicked.");
}

static void edit_camera(struct viewer *v)
{
    struct look *look = &v->look;
    bool changed = ui_numbers("eye (m)", look->eye, 3, 0.01f * look->speed, "%.3f");
    float angles[2] = { look->yaw * 57.29578f, look->pitch * 57.29578f };
    if (ui_numbers("yaw, pitch (°)", angles, 2, 0.5f, "%.1f")) {
        look_turn(look, angles[0] / 57.29578f - look->yaw, angles[1] / 57.29578f - look->pitch);
        changed = true;
    }
    changed |= ui_number("field of view (°)", &look->fov_deg, 5.0f, 150.0f, "%.1f", false);
    if (changed) look->moved = true;
    if (changed) viewer_change(v);
    ui_number("speed (m/s)", &look->speed, 0.01f, 1000.0f, "%.2f", true);
    if (look->moved && ui_button("Reset camera")) viewer_set_camera(v, v->scene_camera);
}

static void edit_exposure(struct viewer *v)
{
    struct ag_finished_frame finished = { 0 };
    ag_renderer_finished(v->main.renderer, &finished);
    if (ui_switch("automatic exposure", &v->auto_exposure)) {
        v->exposure_ev = finished.exposure_ev;
        viewer_touch(v);
    }
    int metering = (int)v->metering;
    if (v->auto_exposure) {
        ui_faint("EV %.2f at ISO 100", (double)finished.exposure_ev);
        if (ui_choice("metering", &metering, viewer_meterings, 2))
            viewer_set_metering(v, (enum ag_metering)metering);
    } else if (ui_number("exposure (EV)", &v->exposure_ev, -6.0f, 22.0f, "%.2f", false)) {
        viewer_touch(v);
    }
    int curve = (int)v->tonemap;
    if (ui_choice("tone curve", &curve, viewer_curves, 3))
        viewer_set_tonemap(v, (enum ag_tonemap)curve);
}

static void choose_layer(struct viewer *v)
{
    int layer = v->layer;
    if (ui_choice("layer", &layer, viewer_layers, viewer_layer_count)) viewer_set_layer(v, layer);
    ui_tooltip("What is shown: all light (color), a part of it, or the surfaces.");
}

static void edit_time(struct viewer *v)
{
    struct ag_animation_info info;
    float time_s = (float)v->time_s;
    if (ag_scene_get_animation(v->desc->scene, v->desc->animation < 0 ? 0 : v->desc->animation,
                               &info) != AG_OK)
        return;
    if (!ui_section("Animation", true)) return;
    if (ui_button(v->playing ? "Pause" : "Play")) v->playing = !v->playing;
    ui_same_line();
    ui_faint("%s, %.2f s", info.name[0] ? info.name : "unnamed", info.duration_s);
    if (info.duration_s > 0) {
        while (time_s > (float)info.duration_s) time_s -= (float)info.duration_s;
        if (ui_number("time (s)", &time_s, 0, (float)info.duration_s, "%.3f", false)) {
            v->time_s = (double)time_s;
            viewer_change(v);
        }
    }
}

static void open_file(struct viewer *v)
{
    ui_line("scene", v->scene_file, sizeof v->scene_file);
    ui_tooltip(
        "A glTF file, a built-in scene (@atrium …) or a saved session. Files can be dropped on "
        "the window.");
    ui_disable(!v->scene_file[0]);
    if (ui_button("Open")) viewer_open(v, v->scene_file);
    ui_enable();
    for (int i = 0; i < v->desc->recent_count; i++)
        if (ui_selectable(v->desc->recent[i], false)) viewer_open(v, v->desc->recent[i]);
}

static void keep_session(struct viewer *v)
{
    ui_line("session", v->session, sizeof v->session);
    ui_tooltip(
        "All that was changed and what is shown, as JSON. A file dropped on the window is read.");
    if (ui_button("Save session")) session_file_write(v, v->session);
    ui_same_line();
    if (ui_button("Load session")) session_file_read(v, v->session);
}

static void take_away(struct viewer *v)
{
    ui_line("file", v->file, sizeof v->file);
    ui_tooltip(".png: exposed and tone mapped; .exr: linear physical values");
    if (ui_button("Save image")) viewer_write(v, v->file);
    ui_same_line();
    if (ui_button("Save window"))
        snprintf(v->screenshot, sizeof v->screenshot, "%s", "afterglow-window.png");
    if (ui_button("Copy as command")) {
        char command[METHOD_SPEC];
        if (viewer_command(v, command, sizeof command)) {
            window_set_clipboard(v->window, command);
            viewer_say(v, "copied: %s", command);
        }
    }
    ui_tooltip("The command line that renders this view: afterglow render …");
}

void panel_view(struct viewer *v)
{
    if (ui_section("Camera", true)) {
        choose_camera(v);
        edit_camera(v);
    }
    if (ui_section("Image", true)) {
        choose_layer(v);
        edit_exposure(v);
        if (ui_number("render scale", &v->scale, 0.1f, 2.0f, "%.2f", false)) viewer_change(v);
        ui_tooltip("Pixels that are rendered for each pixel of the window, along each side. "
                   "Smaller is faster.");
    }
    edit_time(v);
    if (ui_section("Camera path", false)) panel_path(v);
    if (ui_section("Take away", true)) take_away(v);
    if (ui_section("Session", true)) keep_session(v);
    if (ui_section("Open", false)) open_file(v);
}
