// Push constants of view.comp. Scalar layout.
#ifndef AG_PROBES_VIEW_SHARED_H
#define AG_PROBES_VIEW_SHARED_H

#include "core/shared.h"

#ifndef AG_GLSL
#include "frame/frame_shared.h"
#endif

struct probe_view_push {
    AG_STRUCT(frame_probes) grid;
    int32_t every; // probes from one sphere to the next
    int32_t visibility;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct probe_view_push) == 10 * 4, "layout is shared with GLSL");
#endif

#endif
