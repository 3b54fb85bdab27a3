// The path-traced reference of the same view, on a thread beside the frames: it begins again when
// anything changes.
#pragma once

#include "viewer/scene/edits.h"
#include "viewer/viewer.h"

struct truth;

enum { TRUTH_SAMPLES = 4096 }; // at most, of each pixel

struct truth_view {
    struct ag_camera camera;
    int width, height, animation;
    double time_s;
    float ev; // of the errors
    const struct edits *edits;
};

// NULL: no thread. The scene is loaded there a second time.
struct truth *truth_open(const struct viewer_desc *desc);
void truth_close(struct truth *truth); // accepts NULL
// The view changes: nothing is traced until truth_restart.
void truth_pause(struct truth *t);
// Begins again with another view.
void truth_restart(struct truth *truth, const struct truth_view *view);
// The image whose error is measured, radiance, and its exposure; copied. false: it is of another
// size.
bool truth_offer(struct truth *truth, const struct ag_image *color, float ev);

struct truth_state {
    int samples;           // of each pixel so far
    bool measured;         // the following are set
    double flip, energy;   // of the offered image: FLIP, mean luminance over the reference's
    double relative_error; // relmse
    char error[512];       // "": none
};
void truth_get(struct truth *truth, struct truth_state *out);
// The newest image of radiance, or the FLIP at each pixel as a display image, if it is newer than
// that of the last call; the caller destroys it with free() of its pixels.
bool truth_take(struct truth *truth, bool difference, struct ag_image *out);
