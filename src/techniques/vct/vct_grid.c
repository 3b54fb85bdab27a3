#include "techniques/vct/vct_grid.h"

#include <math.h>

bool vct_grid_fit(struct box3 bounds, int dim, struct vct_grid *out)
{
    if (box3_is_empty(bounds)) return false;
    const vec3s size = box3_size(bounds);
    const double longest = (double)fmaxf(size.x, fmaxf(size.y, size.z));
    if (!(longest > 0.0) || !isfinite(longest)) return false;
    // Snapping outwards to pairs on both sides costs less than two pairs.
    const double least = longest / ((double)dim - 4.0);
    const double cell = exp2(ceil(16.0 * log2(least)) / 16.0), pair = 2.0 * cell;
    out->cell_m = (float)cell;
    for (int axis = 0; axis < 3; axis++) {
        const double first = floor((double)bounds.min.raw[axis] / pair);
        const double last = ceil((double)bounds.max.raw[axis] / pair);
        out->origin_m.raw[axis] = (float)(first * pair);
        out->cells[axis] = 2 * (int32_t)fmin(fmax(last - first, 1.0), (double)(dim / 2));
    }
    return isfinite(out->cell_m) && out->cell_m > 0.0f;
}
