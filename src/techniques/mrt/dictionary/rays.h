// Sets of rays that measure light at a point: directions around +z, and for each ray the weight of
// its radiosity in each measured quantity (Loos 2015, sections 3.5.4, 3.5.5 and 3.6.1). One set
// serves all points.
#pragma once

#include "core/host.h"
#include "core/vec.h"

enum mrt_measure {
    MRT_IRRADIANCE, // 1: irradiance of the plane z = 0
    MRT_VECTOR,     // 4: irradiance as a function of the normal, OHLSH in the frame of the point
    MRT_PROBE,      // 9: irradiance as a function of the normal, SH in the frame of the point
};

enum { MRT_MEASURES = 3, MRT_VECTOR_COEFFICIENTS = 4, MRT_PROBE_COEFFICIENTS = 9 };

struct mrt_rays {
    int count, values; // `values`: quantities per ray
    vec3s *direction;  // count
    float *weight;     // count × values
};

// `count` is a power of two: Sobol points are then stratified.
bool mrt_rays_init(struct host *host, enum mrt_measure measure, int count, struct mrt_rays *rays);
void mrt_rays_finish(struct host *host, struct mrt_rays *rays);

// Appendix B: the linear SH that are closest over the hemisphere z > 0 to nine coefficients.
void mrt_ohlsh_from_sh9(const float sh[MRT_PROBE_COEFFICIENTS], float out[MRT_VECTOR_COEFFICIENTS]);
