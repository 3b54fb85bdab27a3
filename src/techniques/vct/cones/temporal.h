// What the temporal filter keeps from frame to frame (Hong 2015, sec. 4.3).
#pragma once

#include "frame/frame.h"
#include "techniques/vct/vct_shared.h"

struct vct_temporal {
    const char *owner; // the technique, whose name passes and images have; set before all else
    gpu_pipeline filter;
    gpu_image now; // RGBA16F: irradiance as this frame alone has it
    gpu_image
        light[2]; // RGBA32F: irradiance, frames in it; the last frame's and this one's in turn
    gpu_image surface[2];             // RG32F: what was seen, see cones/temporal.comp
    int newest;                       // of the two
    bool unlit;                       // what is filtered depends on no light and has no unit
    bool known;                       // there is a last frame
    uint64_t index;                   // of that frame
    uint32_t number;                  // frames since there was none
    uint32_t still;                   // frames since something changed
    struct world_camera camera;       // the last frame's
    vec3s sky;                        // the last frame's, scaled
    struct vct_history_params params; // of the frame being recorded
};

bool vct_temporal_create(struct vct_temporal *t, struct gpu *gpu);
bool vct_temporal_resize(struct vct_temporal *t, struct gpu *gpu, uint32_t width, uint32_t height);
void vct_temporal_destroy(struct vct_temporal *t, struct gpu *gpu); // accepts any half-built state
uint64_t vct_temporal_memory(uint32_t width, uint32_t height);
void vct_temporal_forget(struct vct_temporal *t);

// Once a frame, before its cones: sees what is left of the last one. most: weight of the history
// where things move.
void vct_temporal_begin(struct vct_temporal *t, const struct frame_view *view, int32_t most,
                        float clamp);
// Gives this frame other cones than the last one's, and each pixel others of them. The first frame
// after a cut has the cones as they are.
void vct_temporal_turn(const struct vct_temporal *t, struct vct_cone_params *params);
// From `now` to `result`.
void vct_temporal_record(struct vct_temporal *t, struct gpu_cmd *cmd, const struct frame_view *view,
                         gpu_image result);
