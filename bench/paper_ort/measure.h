// Transfer maps of one size and number: bake, bins, times of the passes, and errors.
#pragma once

#include "bench.h"

#include "paper_ort/copy.h"
#include "paper_ort/map.h"

enum { ORT_VARIANTS = 4, ORT_STAGES = 6, GI_SIZE = 1024 };
enum ort_stage {
    STAGE_DIRECT,
    STAGE_SPREAD,
    STAGE_PREFILTER,
    STAGE_GATHER,
    STAGE_FINISH,
    STAGE_LIGHT_MAP
};
extern const char *const ort_stages[ORT_STAGES];
// Tiles before slices, halves before bytes: the first is the default.
extern const struct ort_variant {
    const char *order, *precision;
} ort_variants[ORT_VARIANTS];

// The scene without a sky, if it has other light, and a path-traced image of it.
struct ort_view {
    const struct bench *bench;
    const char *options; // more options of ort, or NULL
    int threads;         // of the plain copy
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    struct ag_image *reference, *mask; // NULL: no errors
    float ev;
    double power; // mean of the reference's squares over pixels with a surface
};
enum ag_result ort_view_open(struct ort_view *view, const char *scene, int spp);
void ort_view_close(struct ort_view *view);

// Errors of irradiance over pixels with a surface; NaN without a reference.
struct ort_error {
    double l2; // root mean square over that of the reference
    double relmse, flip, energy;
};
// Figures of any GI spec.
enum ag_result ort_error_of(const struct ort_view *view, const char *gi, struct ort_error *out);

struct ort_result {
    double stage_ms[ORT_STAGES]; // least
    uint64_t bytes;              // of the technique
    int bins;
    uint64_t map_bytes; // of the bins, which the gather reads
    struct copy_time copy;
    struct ort_error error;
};
struct ort_setting {
    struct map_size map;
    int offsets;
    double bake_s, processor_s; // NaN: from the cache, which has the first
    struct ort_result results[ORT_VARIANTS];
};
// map and offsets are given.
enum ag_result ort_setting_measure(const struct ort_view *view, struct ort_setting *out);

// Times of the passes with a number of point lights about the scene's bounds instead of its lights.
enum ag_result ort_lights_measure(const struct ort_view *view, const struct ort_setting *setting,
                                  int lights, double stage_ms[ORT_STAGES]);
