// Clutter between two points of a cell.
#include "techniques/mrt/clutter/delta.h"

#include <math.h>

// Rays start and end so much of their way from walls: clutter may stand on them.
static const float OFFSET = 1e-3f;

// Whether the segment from start to start + way touches the box.
static bool touches(struct box3 box, vec3s start, vec3s way)
{
    float enter = 0.0f, leave = 1.0f;
    for (int a = 0; a < 3; a++) {
        // Infinite where the segment is at right angles to the axis.
        const float one = (box.min.raw[a] - start.raw[a]) / way.raw[a];
        const float other = (box.max.raw[a] - start.raw[a]) / way.raw[a];
        enter = fmaxf(enter, fminf(one, other));
        leave = fminf(leave, fmaxf(one, other));
    }
    return !(enter > leave);
}

bool mrt_delta_blocked(const struct mrt_delta_input *input, vec3s from, vec3s to,
                       struct trace_hit *hit)
{
    const vec3s start = mrt_warp_point(input->block->corner, from);
    const vec3s way = glms_vec3_sub(mrt_warp_point(input->block->corner, to), start);
    if (!touches(input->bounds, start, way)) return false;
    return trace_closest(input->objects, glms_vec3_muladds(way, OFFSET, start), way,
                         1.0f - 2.0f * OFFSET, hit);
}
