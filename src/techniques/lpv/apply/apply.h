// Irradiance and specular light of each pixel, from all cascades.
#pragma once

#include "gpu/gpu.h"

struct lpv_application {
    gpu_pipeline plain, damped; // without and with the option `damping`
};

struct lpv_cascade;
struct lpv_frame;

void lpv_record_application(const struct lpv_application *application,
                            const struct lpv_frame *frame, const struct lpv_cascade *finest);
