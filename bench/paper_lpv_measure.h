// What is measured of a scene of the paper: a line of irradiance beside the reference's, costs, a
// picture.
#pragma once

#include "paper_lpv_scenes.h"
#include "passes.h"

enum { MEASURE_TECHNIQUES = 2, MEASURE_COLUMNS = 480 };

struct measure {
    struct ag_context *context;
    struct ag_device *device;
    int frames, spp, picture_spp, picture_width;
    bool paper_settings; // the scene's dim and steps, one grid and one bounce; else what the
                         // techniques take by themselves
    const char *options; // more of them for both techniques, "key=value,…"; may be NULL
    int width, height;   // of the last frames measured
};

struct technique_cost {
    // Sums over the technique's own passes, by the stage in their names; the medians of several
    // frames.
    double inject_ms, propagate_ms, apply_ms, other_ms, technique_ms, frame_ms;
    uint64_t bytes; // of GPU memory that is the technique's own
};

struct measured {
    const char *technique;
    char gi[256];
    double lux[MEASURE_COLUMNS]; // the irradiance's luminance
    double error;                // the mean of |lux - reference| over the reference's mean
    double relmse;               // of the line, as ag_image_metrics has it
    double picture_relmse;       // of the picture's radiance; negative: there is none
    struct technique_cost cost;
};

struct scanline {
    int count, technique_count;
    double x[MEASURE_COLUMNS], reference[MEASURE_COLUMNS];
    struct measured techniques[MEASURE_TECHNIQUES];
};

// Fills the line anew: the reference and all of `lpv` and `holpv` that the library has.
enum ag_result measure_scanline(struct measure *measure, const struct paper_scene *scene,
                                struct ag_scene *loaded, struct scanline *out);
enum ag_result measure_costs(struct measure *measure, const struct paper_scene *scene,
                             struct ag_scene *loaded, struct scanline *line);
// The reference and the techniques from left to right, at one exposure.
enum ag_result measure_picture(struct measure *measure, const struct paper_scene *scene,
                               struct ag_scene *loaded, struct scanline *line,
                               struct ag_image **out);
