// Another method or the reference beside the first, and the error.
#include "panel.h"

#include "viewer/operations.h"
#include "viewer/methods/running.h"

static void show_errors(struct viewer *v)
{
    struct truth_state state;
    truth_get(v->truth, &state);
    if (state.error[0]) {
        ui_warning("%s", state.error);
        return;
    }
    ui_text("%d samples a pixel", state.samples);
    if (!state.measured || !v->offered) {
        ui_faint("errors follow when the image has settled");
        return;
    }
    ui_text("FLIP %.4f", state.flip);
    ui_tooltip("Perceived difference, 0 (equal) to 1: docs/metrics.md");
    ui_text("relative squared error %.4g", state.relative_error);
    ui_text("energy %.4f", state.energy);
    ui_tooltip("Mean luminance over that of the reference.");
}

void panel_compare(struct viewer *v)
{
    static const char *const names[] = { "nothing", "another method", "the reference" };
    int with = v->truth ? 2 : v->split ? 1 : 0;
    if (ui_choice("with", &with, names, 3)) {
        viewer_set_reference(v, with == 2);
        viewer_set_split(v, with == 1 ? "none" : NULL);
    }
    ui_tooltip("A line divides the image: drag it.");
    bool side = v->side_by_side;
    if (with > 0 && ui_switch("side by side", &side)) viewer_set_side_by_side(v, side);
    if (v->truth) {
        ui_switch("show the difference", &v->difference);
        ui_tooltip("FLIP at each pixel, from dark to bright, from the next samples on.");
        show_errors(v);
    }
    if (v->split) panel_edit_method(v, true);
}
