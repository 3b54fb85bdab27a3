// Data of probes that the host uploads for the shaders. Scalar layout.
#ifndef AG_RADIOSITY_PROBES_SHARED_H
#define AG_RADIOSITY_PROBES_SHARED_H

#include "core/shared.h"

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

struct radiosity_gpu_probe {
    vec4s place;  // offset from the grid, in spacings; 1, or 0: it shows another's light
    float sky[9]; // irradiance of a sky of radiance 1, Σ c_i Y_i
};

// A column of the light of emissive surfaces at a probe: irradiance of a radiance of 1, Σ c_i Y_i.
struct radiosity_gpu_probe_emission {
    float sh[9];
};

struct radiosity_probe_gather_push {
    AG_STRUCT(frame_probes) grid;
    uint32_t probes, entries; // entries: of a row
    uint32_t columns;         // of emission; 0: emissive surfaces are no sources
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct radiosity_gpu_probe) == 52, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_probe_emission) == 36, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_probe_gather_push) == 44, "layout is shared with GLSL");
#endif

#endif
