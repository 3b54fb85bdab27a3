// Data of the pass that lights pixels by probes. Scalar layout.
#ifndef AG_PROBES_APPLY_SHARED_H
#define AG_PROBES_APPLY_SHARED_H

#include "core/shared.h"

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

#define PROBE_APPLY_LOCAL 8 // workgroup size in x and y

struct probe_apply_push {
    AG_STRUCT(frame_probes) grid;
    // Columns of the image in which a light map lit pixels whose alpha is not 0: all or none.
    int32_t map_columns;
    uint32_t has_dielectric;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct probe_apply_push) == 40, "layout is shared with GLSL");
#endif

#endif
