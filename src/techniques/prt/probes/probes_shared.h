// Data of the pass that lights probes. Scalar layout.
#ifndef AG_PRT_PROBES_SHARED_H
#define AG_PRT_PROBES_SHARED_H

#include "core/shared.h"

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

#define PRT_PROBES_LOCAL 64

// Parts of a probe in its table: entry part · probes + probe.
#define PRT_PROBE_OFFSET 0 // from the grid, in spacings; 1, or 0: it shows another's light
#define PRT_PROBE_LIGHT  1 // of emissive surfaces, radiance by coefficient, cd/m²

struct prt_probes_push {
    AG_STRUCT(frame_probes) grid;
    uint32_t probes, rows;
    float emitters; // factor of the light of emissive surfaces
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct prt_probes_push) == 44, "layout is shared with GLSL");
#endif

#endif
