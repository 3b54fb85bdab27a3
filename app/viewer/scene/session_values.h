// The content of a session file.
#pragma once

#include "viewer/state.h"

#include <jansson.h>

struct session_values {
    struct viewer *v;
    struct look look;
    int scene_camera;
    double time_s;
    bool auto_exposure, difference, reference, side_by_side;
    float exposure_ev, scale, split_at, budget_ms;
    int layer, tonemap, metering;
    const char *debug_view;                      // NULL: none
    char gi[METHOD_SPEC], other_gi[METHOD_SPEC]; // other_gi: "": none
    struct edits edits;
    struct path camera_path;
    struct dabs paint; // the owner closes it
};

// Takes the members of a document over the values that are there. False, with a message, if one is
// wrong: the values are then of no use.
bool session_values_read(struct session_values *s, json_t *document, const char *path);
