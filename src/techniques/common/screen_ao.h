// What techniques that look for occluders in the depth buffer have in common: the picture's
// geometry (screen_ao.glsl), and the way from their noisy estimate to the frame's visibility.
#pragma once

#include "frame/frame.h"

#include "techniques/common/screen_ao_shared.h"

struct screen_ao_options {
    bool blur;     // evens the estimate out over 4 × 4 pixels, not across edges
    bool half;     // the estimate has half the frame's size
    bool temporal; // estimates of frames are averaged; the owner needs FRAME_NEEDS_MOTION
};

struct screen_ao {
    struct gpu *gpu;
    struct screen_ao_options options;
    uint32_t width, height, work_width, work_height;
    gpu_image
        estimate; // RG32F: visibility, depth of the frame's pixel; (1, 0) where there is no surface
    gpu_image scratch; // RG32F
    gpu_image
        history[2]; // RGBA32F: visibility, depth, frames; the last frame's and this one's in turn
    int newest;     // of the two
    float before_near_m; // of the last frame's camera; 0: forget the history
    gpu_pipeline temporal, blur_x, blur_y, fit;
    struct screen_ao_params params; // of the frame being recorded
};

// false: screen_ao_finish frees what was created.
bool screen_ao_init(struct screen_ao *ao, struct gpu *gpu, const struct screen_ao_options *options,
                    uint32_t width, uint32_t height);
bool screen_ao_resize(struct screen_ao *ao, uint32_t width, uint32_t height);
void screen_ao_finish(struct screen_ao *ao); // accepts zero
uint64_t screen_ao_memory(const struct screen_ao_options *options, uint32_t width, uint32_t height);

// The constant that all shaders of the estimate take: SCREEN_AO_STEP.
struct gpu_constant screen_ao_step(const struct screen_ao *ao);

// Once a frame, before the estimate. radius_m: of the sphere; reach: its radius on the screen at
// most, in picture heights.
void screen_ao_begin(struct screen_ao *ao, const struct frame_view *view, float radius_m,
                     float reach);
// The block "screen_ao".
struct gpu_binding screen_ao_binding(const struct screen_ao *ao, struct gpu_cmd *cmd);
// The estimate: `pipeline` with a shader that includes screen_ao_estimate.glsl. more: its own
// bindings, one at least and SCREEN_AO_MORE at most. name: of the pass.
enum { SCREEN_AO_MORE = 2 };
void screen_ao_estimate(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view,
                        const char *name, gpu_pipeline pipeline, const struct gpu_binding *more,
                        int more_count);
// After the estimate: fills the frame's visibility. Passes "temporal", "blur" and "fit".
void screen_ao_record(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view);
