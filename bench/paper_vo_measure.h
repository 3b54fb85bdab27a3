// Time, error and steadiness of techniques of the role visibility, in one view of a scene.
#pragma once

#include <afterglow/afterglow.h>

struct vo_view {
    struct ag_context *context;
    struct ag_device *device;
    int width, height, frames, spp;
    float radius_m;
    struct ag_scene *scene;
    struct ag_frame_desc frame;
    // Traced: obscurance of that radius, and with a second of a quarter of it; the sky that is open
    // so far.
    struct ag_image *obscurance, *of_two_radii, *ambient, *depth;
};

struct vo_result {
    double geometry_ms, pyramid_ms, estimate_ms, after_ms; // least of all frames
    double mean_error, rms_error, bias; // from the traced obscurance, where there is a surface
    double ambient_error;               // mean, from the traced ambient occlusion
    double change; // mean difference from frame to frame in a pan of half a pixel a frame
};

// radius_share: of the diagonal of the scene's bounds. The caller fills context … spp.
// vo_view_close frees what was made, also after a failure.
enum ag_result vo_view_open(struct vo_view *view, const char *scene, double radius_share);
void vo_view_close(struct vo_view *view);
// gi: "vo:samples=5", whose radius is the view's. twice: with the second radius.
enum ag_result vo_measure(const struct vo_view *view, const char *gi, bool twice,
                          struct vo_result *out);
