// A scene under distant light alone, which turns: an image of a sky with two broad lights.
#pragma once

#include "bench.h"

struct prt_view {
    const struct bench *bench;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    struct ag_environment *environment;
};
// metal: all surfaces become metal of roughness 0.5; textures stay. Close in any case.
enum ag_result prt_view_open(struct prt_view *view, const char *scene, bool metal);
// Radians about +y; the next frame shows it.
enum ag_result prt_view_turn(struct prt_view *view, float rotation);
void prt_view_close(struct prt_view *view);

// Renders the frame and reads its colour.
enum ag_result prt_view_render(const struct prt_view *view, struct ag_renderer *renderer,
                               struct ag_image **out);

// An image that others are compared with, and its pixels with a surface.
struct prt_baseline {
    struct ag_image *image, *mask;
    float ev;
};
enum ag_result prt_baseline_create(const struct prt_view *view, const char *gi,
                                   struct prt_baseline *out);
void prt_baseline_destroy(const struct prt_view *view, struct prt_baseline *baseline);
// Errors of all pixels, and of those with a surface.
struct prt_flip {
    double all, surface;
};
enum ag_result prt_baseline_flip(const struct prt_view *view, const struct prt_baseline *baseline,
                                 struct ag_renderer *renderer, struct prt_flip *out);
