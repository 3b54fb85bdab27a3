// Temporal accumulation (Hong 2015, sec. 4.3).
#pragma once

#include "techniques/common/kept.h"
#include "techniques/vct/cones/cones_shared.h"

enum { VCT_ROTATION_FRAMES = 4 }; // with one rotation, while light changes

struct vct_temporal_pipelines {
    gpu_pipeline first, keep, follow; // without a history; with one; it follows a change of light
    gpu_pipeline denoise[2];          // its passes
};

struct vct_temporal {
    // Ping-pong: of this frame and of the previous one.
    gpu_image now[2];           // RGBA16F: irradiance of the frame alone
    gpu_image change[2];        // RGBA16F: last known change of it, while light changes
    gpu_image light[2];         // RGBA32F: irradiance, weight in frames
    gpu_image surface[2];       // RGBA32F: depth, normal and deviations, see temporal.comp
    int newest;                 // index of this frame's history
    bool unlit;                 // visibility is filtered: independent of lights and radiance scale
    struct kept kept;           // known: the history is valid
    uint32_t number;            // rotations since the history began
    uint32_t frame;             // frames since then
    int held;                   // frames with the rotation of this one before it
    bool whole;                 // the first of them has added it to the mean with its whole weight
    uint32_t still;             // frames since anything changed
    struct frame_camera camera; // of the previous frame
    struct vct_history_params params; // of the frame being recorded
};

void vct_temporal_invalidate(struct vct_temporal *t);

// Once per frame, before its cones. block: px along a side that share one set of cones or rays;
// most: maximum history weight while anything moves; settles: the light volume still follows an
// earlier change.
void vct_temporal_begin(struct vct_temporal *t, const struct frame_view *view, uint32_t block,
                        int32_t most, float clamp, bool settles);
// Rotates the cones of this frame and permutes them over the pixels. The first frame of a history
// keeps them.
void vct_temporal_rotate_cones(const struct vct_temporal *t, struct vct_cone_params *params);
// The image of this frame's cones.
gpu_image vct_temporal_now(const struct vct_temporal *t);
// Blends it with the history; writes the new history, and `result` where it is not denoised.
void vct_temporal_record(struct vct_temporal *t, const struct vct_temporal_pipelines *pipelines,
                         struct gpu_cmd *cmd, const struct frame_view *view, gpu_image result);
// Writes the history to `result`, averaged over pixels. scene_m: longest side of the scene;
// wide_frames: first frames of a history with further passes.
void vct_temporal_denoise(const struct vct_temporal *t,
                          const struct vct_temporal_pipelines *pipelines, struct gpu_cmd *cmd,
                          const struct frame_view *view, float scene_m, int32_t wide_frames,
                          gpu_image result);
