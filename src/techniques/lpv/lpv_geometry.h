// The geometry volume: what stands in the way of the light (Martin 2012, sec. 3.2.2; Hong 2015,
// sec. 2.5.2.4). README.md says what each choice is and how good.
#pragma once

#include "techniques/lpv/lpv_grid.h"

#include "gpu/gpu.h"

struct lpv;
struct lpv_options;
struct frame_view;

// Of passes and objects, "technique.thing".
struct lpv_geometry_names {
    const char *volume, *shares, *to_shares;
    const char *areas, *light, *camera, *merge;
    const char *still, *moving, *lines, *masked_lines, *faces;
};
#define LPV_GEOMETRY_NAMES(technique)                                                              \
    {                                                                                              \
        .volume = technique ".geometry", .shares = technique ".shares",                            \
        .to_shares = technique ".geometry_shares", .areas = technique ".areas",                    \
        .light = technique ".geometry_light", .camera = technique ".geometry_camera",              \
        .merge = technique ".geometry_merge", .still = technique ".still_lines",                   \
        .moving = technique ".moving_lines", .lines = technique ".geometry_lines",                 \
        .masked_lines = technique ".geometry_masked_lines", .faces = technique ".geometry_faces",  \
    }

struct lpv_geometry {
    gpu_image volume; // RGBA16F: blocking potential at corners, or covered shares of faces
                      // (lpv_geometry.glsl)
    gpu_pipeline light, camera, merge;       // LPV_GEOMETRY_MAPS
    gpu_buffer areas;                        // [corner][coefficient] of one source
    gpu_pipeline lines, masked_lines, faces; // LPV_GEOMETRY_SCENE
    gpu_buffer still, moving;                // [cell][axis] lines that surfaces cross
    gpu_pipeline to_shares;
    gpu_buffer shares; // [cell][word]: what reaches the neighbours (lpv_shares.glsl)
    // What `still` and `shares` were made of.
    bool kept;
    struct lpv_grid kept_grid;
    int kept_moving_count;
    float kept_blocking;
};

// All of these do nothing where the option is off.
bool lpv_geometry_create(struct lpv *lpv);
void lpv_geometry_destroy(struct lpv *lpv);
uint64_t lpv_geometry_bytes(const struct lpv_options *options);
void lpv_geometry_forget(struct lpv *lpv); // what was kept of still things is made anew
void lpv_record_geometry(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
