// The test scenes of T. L. Martin, "Higher Order Light Propagation Volumes", 2012, chapter 5, as
// near as its text tells.
#pragma once

#include <afterglow/afterglow.h>

struct paper_scene {
    const char *name, *title, *section;
    const char *spec;   // a built-in, or a file of the folder of scenes
    const char *camera; // of the scene; NULL: eye, target, fov
    float eye[3], target[3], fov_deg;
    float sun[3];                          // direction, 100 000 lux; zero: the scene's own light
    const struct ag_area_light_desc *area; // one more light; may be NULL
    // What is plotted: the floor from one point to the other, seen from above, or where both are
    // equal, the middle row of the picture.
    float scan_from[3], scan_to[3];
    int bounces; // of the light that LPV make: 0 for an area light alone, which they bring straight
    int dim, steps; // cells of the paper's size over our bounds, and the paper's steps
    bool occlusion; // whether the paper used its geometry volume
    // Table 5.1, on an NVIDIA GTX 460; 0 where the table has no row.
    int width, height;
    double lpv_ms, holpv_ms;
};

extern const struct paper_scene paper_scenes[];
extern const int paper_scene_count;

// AG_ERROR_FILE with a message in the context: the file is not there.
enum ag_result paper_scene_open(const struct paper_scene *scene, struct ag_context *context,
                                const char *folder, struct ag_scene **out);
enum ag_result paper_scene_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                  struct ag_camera *out);
// The camera whose picture of width × 1 pixels is what is plotted.
enum ag_result paper_scene_scan_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                       int width, struct ag_camera *out);
bool paper_scene_scans_floor(const struct paper_scene *scene);
