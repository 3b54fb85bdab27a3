// Temporal accumulation (Hong 2015, sec. 4.3).
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cones_shared.h"

struct vct_temporal {
    gpu_pipeline filter;
    gpu_image now;              // RGBA16F: irradiance of this frame alone
    gpu_image light[2];         // RGBA32F: irradiance, accumulated frames; ping-pong
    gpu_image surface[2];       // RG32F: depth and normal, see temporal.comp
    int newest;                 // index of this frame's history
    bool unlit;                 // visibility is filtered: independent of lights and radiance scale
    bool known;                 // the history is valid
    uint64_t index;             // of the previous frame
    uint32_t number;            // frames since the history began
    uint32_t still;             // frames since anything changed
    struct world_camera camera; // of the previous frame
    vec3s sky;                  // of the previous frame, scaled
    struct vct_history_params params; // of the frame being recorded
};

bool vct_temporal_create(struct vct_temporal *t, struct gpu *gpu);
bool vct_temporal_resize(struct vct_temporal *t, struct gpu *gpu, uint32_t width, uint32_t height);
void vct_temporal_destroy(struct vct_temporal *t, struct gpu *gpu); // accepts any half-built state
uint64_t vct_temporal_memory(uint32_t width, uint32_t height);
void vct_temporal_invalidate(struct vct_temporal *t);

// Once per frame, before its cones. most: maximum history weight while anything moves.
void vct_temporal_begin(struct vct_temporal *t, const struct frame_view *view, int32_t most,
                        float clamp);
// Rotates the cones of this frame and permutes them over the pixels. The first frame of a history
// keeps them.
void vct_temporal_rotate_cones(const struct vct_temporal *t, struct vct_cone_params *params);
// Blends `now` with the history; writes `result` and the new history.
void vct_temporal_record(struct vct_temporal *t, struct gpu_cmd *cmd, const struct frame_view *view,
                         gpu_image result);
