// The side bar with its tabs, and the status line.
#include "panels.h"

#include "viewer/operations.h"
#include "panel.h"
#include "overlay.h"
#include "viewer/methods/running.h"
#include "viewer/scene/undo.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *label;
    void (*draw)(struct viewer *v);
} tabs[] = { { "View", panel_view },       { "Light", panel_light }, { "Method", panel_method },
             { "Compare", panel_compare }, { "Cost", panel_cost },   { "Inspect", panel_inspect } };

static void draw_status(struct viewer *v)
{
    const struct region r = viewer_images(v);
    const float scale = window_scale(v->window), height = 20.0f * scale;
    char text[VIEWER_MESSAGE + 128];
    const bool message = v->message[0] && window_seconds() < v->message_until_s;
    if (message)
        snprintf(text, sizeof text, "%s", v->message);
    else
        snprintf(text, sizeof text, "%.1000s   %dx%d   %.0f ms a frame", v->gi, v->main.width,
                 v->main.height, (double)v->times.frame_ms[v->times.newest]);
    ui_box(r.x0, r.y1 - height, r.x1, r.y1, 0x101012d0);
    ui_label(r.x0 + 6.0f * scale, r.y1 - 0.8f * height,
             message && v->message_warns ? 0xffb85aff : 0xd0d0d0ff, text);
}

static void draw_split_labels(struct viewer *v)
{
    const struct region r = viewer_region(v);
    const float x = r.x0 + viewer_first_share(v) * (r.x1 - r.x0), scale = window_scale(v->window);
    if (!viewer_is_divided(v)) return;
    ui_stroke(x, r.y0, x, r.y1, 0xffffffc0, 2.0f * scale);
    char left[128], right[128];
    snprintf(left, sizeof left, "%.120s", v->gi);
    snprintf(right, sizeof right, "%.120s",
             !v->truth       ? v->other_gi
             : v->difference ? "difference to the reference"
                             : "reference");
    const float width = ui_label_width(left);
    ui_box(x - width - 14.0f * scale, r.y0, x, r.y0 + 20.0f * scale, 0x101012b0);
    ui_label(x - width - 8.0f * scale, r.y0 + 3.0f * scale, 0xffffffff, left);
    ui_box(x, r.y0, x + ui_label_width(right) + 14.0f * scale, r.y0 + 20.0f * scale, 0x101012b0);
    ui_label(x + 6.0f * scale, r.y0 + 3.0f * scale, 0xffffffff, right);
}

static bool step_button(const char *label, const char *what, const char *key)
{
    char text[128];
    ui_disable(!what);
    const bool pressed = ui_small_button(label);
    ui_enable();
    snprintf(text, sizeof text, "%s (%s)", what ? what : "nothing", key);
    ui_tooltip(text);
    return pressed && what;
}

static void draw_undo(struct viewer *v)
{
    if (step_button("Undo", undo_previous(v), "control Z")) undo_back(v);
    ui_same_line();
    if (step_button("Redo", undo_next(v), "control shift Z")) undo_forward(v);
}

static void draw_tabs(struct viewer *v)
{
    if (!ui_tabs_begin("tabs")) return;
    for (int i = 0; i < (int)(sizeof tabs / sizeof *tabs); i++) {
        if (!ui_tab_begin(tabs[i].label, v->show_tab == i)) continue;
        tabs[i].draw(v);
        ui_tab_end();
    }
    ui_tabs_end();
    v->show_tab = -1;
}

void panels_draw(struct viewer *v)
{
    const struct region r = viewer_images(v);
    v->inspecting = v->lighting = v->paint.armed = v->block_edit.shown = false;
    overlay_probes(v);
    draw_split_labels(v);
    draw_status(v);
    if (ui_panel_begin("panel", r.x1, 0, (float)v->swapchain.width - r.x1,
                       (float)v->swapchain.height)) {
        draw_undo(v);
        draw_tabs(v);
    }
    ui_panel_end();
    if (!v->inspecting) pixels_forget(v);
}
