// The test scenes of T. L. Martin, "Higher Order Light Propagation Volumes", 2012, chapter 5, as
// far as the text specifies them.
#ifndef AG_BENCH_PAPER_LPV_SCENES_H
#define AG_BENCH_PAPER_LPV_SCENES_H

#include <afterglow/afterglow.h>

struct paper_scene {
    const char *name, *title, *section;
    const char *spec;   // a built-in scene, or a file in the scenes folder
    const char *camera; // name in the scene; NULL: eye, target, fov
    float eye[3], target[3], fov_deg;
    float sun[3];                          // direction, 100 000 lux; zero: the scene's own light
    const struct ag_area_light_desc *area; // additional light; may be NULL
    // The scanline: a line on the floor seen from above; the middle row of the image where both
    // points are equal.
    float scan_from[3], scan_to[3];
    int bounces;    // of the reference: 0 for an area light, whose direct light LPV computes
    int dim, steps; // cells of the paper's size over the scene's bounds; the paper's steps
    bool occlusion; // the paper used its geometry volume
    // Table 5.1, on an NVIDIA GTX 460; 0: not in the table.
    int width, height;
    double lpv_ms, holpv_ms;
};

extern const struct paper_scene paper_scenes[];
extern const int paper_scene_count;

// AG_ERROR_FILE with a message in the context where the file is missing.
enum ag_result paper_scene_open(const struct paper_scene *scene, struct ag_context *context,
                                const char *folder, struct ag_scene **out);
enum ag_result paper_scene_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                  struct ag_camera *out);
// The camera whose image of width × 1 pixels is the scanline.
enum ag_result paper_scene_scan_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                       int width, struct ag_camera *out);
bool paper_scene_scans_floor(const struct paper_scene *scene);

#endif
