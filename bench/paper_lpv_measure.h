// Measurements of one scene of the paper: a scanline of irradiance next to the reference's, costs,
// and an image.
#ifndef AG_BENCH_PAPER_LPV_MEASURE_H
#define AG_BENCH_PAPER_LPV_MEASURE_H

#include "bench.h"
#include "paper_lpv_scenes.h"

enum { MEASURE_TECHNIQUES = 2, MEASURE_COLUMNS = 480 };

struct measure {
    struct bench *bench; // its width and height become those of the scene
    int spp, image_spp, image_width;
    bool paper_settings; // dim and steps of the scene, one grid, one bounce; false: the defaults
    const char *options; // more for both techniques, "key=value,…"; may be NULL
};

// Sums over the technique's own passes by stage; medians over frames.
struct technique_cost {
    double inject_ms, propagate_ms, apply_ms, other_ms, technique_ms, frame_ms;
    uint64_t bytes; // GPU memory of the technique
};

struct measured {
    const char *technique;
    char gi[256];
    double lux[MEASURE_COLUMNS]; // luminance of the irradiance
    double error;                // mean |lux - reference| over the reference's mean
    double relmse;               // of the scanline, as ag_image_metrics
    double image_relmse;         // of the image's radiance; negative: not measured
    struct technique_cost cost;
};

struct scanline {
    int count, technique_count;
    double x[MEASURE_COLUMNS], reference[MEASURE_COLUMNS];
    struct measured techniques[MEASURE_TECHNIQUES];
};

// Resets *out and fills it with the reference and the techniques lpv and holpv.
enum ag_result measure_scanline(struct measure *measure, const struct paper_scene *scene,
                                struct ag_scene *loaded, struct scanline *out);
enum ag_result measure_costs(struct measure *measure, const struct paper_scene *scene,
                             struct ag_scene *loaded, struct scanline *line);
// Reference and techniques from left to right, at one exposure.
enum ag_result measure_image(struct measure *measure, const struct paper_scene *scene,
                             struct ag_scene *loaded, struct scanline *line, struct ag_image **out);

#endif
