// Temporal antialiasing: blends the radiance of jittered frames.
//
// While nothing changes, a pixel has the mean of up to ANTIALIAS_SAMPLES frames, without a test:
// after as many frames it is the box-filtered image. Otherwise the history is reprojected by
// motion, rejected where its distance is that of another surface, and clipped to the variance of
// the neighbourhood (Salvi 2016, "An Excursion in Temporal Supersampling"; Karis 2014, "High
// Quality Temporal Supersampling").
#pragma once

#include "gpu/gpu.h"

#include "frame/composite/antialias_shared.h"

// A bit for each ANTIALIAS_CONSTANT_….
enum antialias_variant {
    ANTIALIAS_MOVES = 1 << ANTIALIAS_CONSTANT_MOVES,
    ANTIALIAS_DISPLAY = 1 << ANTIALIAS_CONSTANT_DISPLAY,
    ANTIALIAS_AGX = 1 << ANTIALIAS_CONSTANT_AGX,
    ANTIALIAS_LINEAR = 1 << ANTIALIAS_CONSTANT_LINEAR,
    ANTIALIAS_VARIANT_COUNT = 1 << ANTIALIAS_CONSTANT_COUNT,
};

struct antialias {
    struct gpu *gpu;
    gpu_pipeline pipelines[ANTIALIAS_VARIANT_COUNT];
    gpu_image no_display; // 1×1 placeholder
};

// RGBA32F: mean scaled radiance; in alpha the distance along the view axis of the nearest surface
// about the pixel, whose lowest seven bits are the number of samples.
struct antialias_history {
    gpu_image images[2];
    int newest;
    bool known;           // there was a frame
    int settles;          // frames until light that follows a change is taken for settled
    bool moves;           // this frame tests the history
    uint32_t most, still; // its weight in samples; frames since the last change
    uint32_t metered;     // frames in the mean of automatic exposure
    // State of the last frame on which a static image depends, beside the camera.
    uint64_t light_hash, draw_list, revision;
};

struct antialias_images {
    gpu_image radiance, depth, motion; // inputs
    gpu_image color, display;
};

bool antialias_prepare(struct antialias *antialias, struct gpu *gpu, uint32_t variant);
void antialias_finish(struct antialias *antialias); // accepts zero
// Creates the images of a view, if there are none.
bool antialias_history_prepare(struct antialias_history *history, struct gpu *gpu, uint32_t width,
                               uint32_t height);
void antialias_history_finish(struct antialias_history *history, struct gpu *gpu);
uint64_t antialias_history_bytes(uint32_t width, uint32_t height);
// bindings: "frame_constants", "exposure_state".
void antialias_record(const struct antialias *antialias, struct gpu_cmd *cmd, uint32_t variant,
                      struct antialias_history *history, uint32_t most,
                      const struct antialias_images *images, const struct gpu_binding bindings[2],
                      uint32_t width, uint32_t height);
