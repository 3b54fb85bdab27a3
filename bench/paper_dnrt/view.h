// A scene with dynamic objects for paper-dnrt: its reference, its objects, and what GI specs make
// of it.
#ifndef AG_BENCH_PAPER_DNRT_VIEW_H
#define AG_BENCH_PAPER_DNRT_VIEW_H

#include "bench.h"

enum { DNRT_MAX_OBJECTS = 16, DNRT_MAX_METHODS = 8, DNRT_STAGES = 3 };

struct dnrt_object {
    int instance;
    float centre[3], radius; // m: of the box of its mesh; half of the box's longest side
};

struct dnrt_view {
    const struct bench *bench; // its size is that of measured times
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    int width, height; // of images
    int spp;           // 0: there is no reference, and errors are 0
    struct dnrt_object objects[DNRT_MAX_OBJECTS];
    int object_count;
    struct ag_image *reference, *position; // indirect light, cd/m²; m
    struct ag_image *near;                 // mask: within two radii of an object, itself included
    struct ag_image *around;               // of these the pixels of other surfaces
    double noise;                          // standard error of the reference, relative to its mean
};

// Loads a scene, finds its movable instances and traces the reference. camera NULL: the first.
enum ag_result dnrt_view_open(struct dnrt_view *view, const char *scene, const char *camera);
// The same of a scene that is open: takes it over.
enum ag_result dnrt_view_open_scene(struct dnrt_view *view, struct ag_scene *scene);
void dnrt_view_close(struct dnrt_view *view);
// A reference of the scene with its objects. out_position may be NULL.
enum ag_result dnrt_view_trace(struct dnrt_view *view, struct ag_image **out,
                               struct ag_image **out_position);

struct dnrt_method {
    char gi[BENCH_TEXT];
    const char *term;             // whose time counts: "dnrt" of "radiosity+dnrt"; "": none
    double ms;                    // of the term's passes together, least of the frames
    double stage_ms[DNRT_STAGES]; // of dnrt: light, volumes, apply
    struct ag_metrics near, around;
};

// Indirect light of the second frame, in which volumes are kept, at the size of images.
enum ag_result dnrt_view_render(const struct dnrt_view *view, const char *gi,
                                struct ag_image **indirect);
enum ag_result dnrt_view_errors(const struct dnrt_view *view, struct dnrt_method *method);
// Measures all methods; their frames alternate. new_light: lights change a little in each frame.
enum ag_result dnrt_view_times(const struct dnrt_view *view, bool new_light,
                               struct dnrt_method *methods, int count);

#endif
