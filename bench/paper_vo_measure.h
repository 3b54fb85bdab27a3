// Time, error and temporal stability of a visibility technique in one view of a scene.
#ifndef AG_BENCH_PAPER_VO_MEASURE_H
#define AG_BENCH_PAPER_VO_MEASURE_H

#include "bench.h"

struct vo_view {
    const struct bench *bench;
    int spp; // of the traced images
    float radius_m;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    // Traced: obscurance of that radius, the mean with that of a quarter of the radius, and ambient
    // occlusion.
    struct ag_image *obscurance, *two_radii, *ambient_occlusion, *depth;
};

struct vo_result {
    double geometry_ms, pyramid_ms, estimate_ms, filter_ms; // minimum over frames
    double mean_error, rms_error, bias;                     // from the traced obscurance
    double ambient_error; // mean, from the traced ambient occlusion
    double change;        // mean difference between frames in a pan of half a pixel per frame
};

// radius_share: relative to the diagonal of the scene's bounds. vo_view_close frees a view, also
// after a failure.
enum ag_result vo_view_open(struct vo_view *view, const char *scene, double radius_share);
void vo_view_close(struct vo_view *view);
// gi: "vo:samples=5"; the radius of the view is added. two_radii: with a second radius.
enum ag_result vo_measure(const struct vo_view *view, const char *gi, bool two_radii,
                          struct vo_result *out);

#endif
