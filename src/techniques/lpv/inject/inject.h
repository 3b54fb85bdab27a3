// Injection: texels of reflective shadow maps and points on emissive surfaces as virtual lights.
#pragma once

#include "gpu/gpu.h"

struct lpv_injection {
    gpu_pipeline rsm, emitters, resolve;
    gpu_buffer sums;    // [cell][coefficient][colour] 64-bit integers
    gpu_image injected; // their light
};

struct lpv_cascade;
struct lpv_frame;

// Virtual lights of a cascade to integer sums, sums to `injected`.
void lpv_record_injection(const struct lpv_injection *injection, const struct lpv_frame *frame,
                          const struct lpv_cascade *cascade);
void lpv_record_resolve(const struct lpv_injection *injection, const struct lpv_frame *frame,
                        const struct lpv_cascade *cascade); // the second of the two
