// Shared by the screen-space occlusion techniques: the sphere's geometry (screen_ao.glsl), and the
// filters from a noisy estimate to the frame's visibility.
#pragma once

#include "frame/frame.h"

#include "techniques/common/screen_ao_shared.h"

struct screen_ao_options {
    bool blur;            // edge-aware mean over 4 × 4 pixels
    bool half_resolution; // of the estimate
    bool temporal;        // accumulate frames; the technique needs FRAME_NEEDS_MOTION
};

struct screen_ao {
    struct screen_ao_options options; // of the frame being recorded, as params
    gpu_image estimate;               // RG32F: visibility, depth; (1, 0) without a surface
    gpu_image scratch;                // RG32F
    gpu_image history[2]; // RGBA32F: visibility, depth, frame count; previous and current alternate
    int newest;           // index into history
    struct frame_camera previous; // of the frame before
    bool has_history;
    uint32_t number; // of the frame, from the beginning of the history
    gpu_pipeline temporal, blur_x, blur_y, upsample;
    struct screen_ao_params params; // of the frame being recorded
};

// The member of a state at offset `base`; its objects are before it in the table.
void screen_ao_objects(const struct screen_ao_options *options, size_t base, uint32_t width,
                       uint32_t height, struct gpu_objects *out);
// The constant SCREEN_AO_CONSTANT_STEP, which every shader of the estimate has.
#define SCREEN_AO_STEP (1u << SCREEN_AO_CONSTANT_STEP)

void screen_ao_invalidate(struct screen_ao *ao); // discards the history
// Once a frame, before the estimate. options: those of the objects; radius_m: of the sphere; reach:
// its largest radius on the screen, in image heights.
void screen_ao_begin(struct screen_ao *ao, struct screen_ao_options options,
                     const struct frame_view *view, float radius_m, float reach);
// The block "screen_ao".
struct gpu_binding screen_ao_binding(const struct screen_ao *ao, struct gpu_cmd *cmd);
// The estimate: `pipeline` has a shader that includes screen_ao_estimate.glsl. extra: its own
// bindings, 1 to SCREEN_AO_EXTRA. name: of the pass.
enum { SCREEN_AO_EXTRA = 2 };
void screen_ao_estimate(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view,
                        const char *name, gpu_pipeline pipeline, const struct gpu_binding *extra,
                        int extra_count);
// Filters the estimate into the frame's visibility. Passes "temporal", "blur" and "upsample".
void screen_ao_record(struct screen_ao *ao, struct gpu_cmd *cmd, const struct frame_view *view);
