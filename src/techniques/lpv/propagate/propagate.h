// Propagation: the steps of a cascade, with bounces between them.
#pragma once

#include "gpu/gpu.h"

struct lpv_propagation {
    gpu_pipeline refine, propagate, bounce;
    gpu_image steps[2]; // ping-pong; half precision: the cascade's light replaces steps[1]
    gpu_image sent;     // bounces: injected light + light that surfaces reflect
};

struct lpv_cascade;
struct lpv_frame;

// From the injected light, or the light of the coarser cascade, to cascade->light.
void lpv_record_propagation(const struct lpv_propagation *propagation,
                            const struct lpv_frame *frame, const struct lpv_cascade *cascade);

// refine.c: resamples the light of the next coarser cascade into `to`, the input of the first
// step.
void lpv_record_refinement(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                           const struct lpv_cascade *cascade, gpu_image to);

// bounce.c
// Whether a bounce follows a step; `left` steps remain after it.
bool lpv_bounces_after(const struct lpv_frame *frame, const struct lpv_cascade *cascade, int left);
// Fills `sent` from the injected light and the light `arrived`.
void lpv_record_bounce(const struct lpv_propagation *propagation, const struct lpv_frame *frame,
                       const struct lpv_cascade *cascade, gpu_image arrived);
