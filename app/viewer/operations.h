// Operations of panels, controls and scripts.
#pragma once

#include "state.h"

#include <jansson.h>

extern const char *const viewer_layers[];
extern const int viewer_layer_count;
extern const char *const viewer_light_types[3]; // by enum ag_light_type

// Says something in the status line, with the library's sentence where `result` is not AG_OK.
void viewer_say(struct viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
void viewer_warn(struct viewer *v, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool viewer_check(struct viewer *v, enum ag_result result);
// Writes a text file and says so; false, with a message, if it cannot.
bool viewer_write_text(struct viewer *v, const char *path, const char *text);
// The same for JSON; takes ownership. NULL: out of memory.
bool viewer_write_json(struct viewer *v, const char *path, json_t *document, size_t flags);
// The image changes: it is rendered until what accumulates over frames has settled.
void viewer_touch(struct viewer *v);
// Scene or camera differ: also the reference begins again.
void viewer_change(struct viewer *v);
// Something has changed that undo brings back: "light 2". index: -1: there is one alone.
#define CHANGE_METHOD "method"
void viewer_note(struct viewer *v, const char *what, int index);
// Takes note of the spec that a rendering runs now.
void viewer_runs(struct viewer *v, bool other, const char *gi);
bool viewer_set_debug_view(struct viewer *v, const char *name); // NULL: none
void viewer_set_layer(struct viewer *v, int layer);
void viewer_set_camera(struct viewer *v, int scene_camera); // -1: that of the command line
// The part of the window beside the panels, and the first image in it: all of that part, or its
// left half with images side by side.
struct region viewer_images(const struct viewer *v);
struct region viewer_region(const struct viewer *v);
bool viewer_is_divided(const struct viewer *v); // a second method or the reference is shown
bool viewer_is_side_by_side(const struct viewer *v);
// The first method's share of the first image's width: 1 without a split line.
float viewer_first_share(const struct viewer *v);
void viewer_set_side_by_side(struct viewer *v, bool on);
// Options of the command line that load and light the scene so, a blank before each word.
void viewer_scene_options(const struct viewer *v, char *out, size_t size);
// The pixel of the window at which a point of the scene appears; false: it is behind the camera.
bool viewer_project(const struct viewer *v, const float point[3], float *x, float *y);
// The ray of a pixel of the window, from the camera; `direction` is a unit vector.
void viewer_ray(const struct viewer *v, float x, float y, float eye[3], float direction[3]);
// EV of the image that is shown.
float viewer_exposure(const struct viewer *v);
// The size in pixels that the image is to have.
void viewer_image_size(const struct viewer *v, int *width, int *height);
