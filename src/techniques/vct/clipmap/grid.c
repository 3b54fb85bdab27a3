#include "techniques/vct/clipmap/grid.h"

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
        out->scene[axis] = out->cells[axis];
        out->first[axis] = 0;
    }
    return isfinite(out->cell_m) && out->cell_m > 0.0f;
}

// ---- Grids around the camera --------------------------------------------------------------------

// Placement of a grid along one axis, in its voxels from the scene's corner.
struct span {
    double scene;   // extent of the scene
    double most;    // largest offset
    double centred; // offset that centres it on the camera, unquantized
    double step;    // quantum of the offset: multiple of 4, a texel of the next coarser grid
};

static struct span span_of(const struct vct_grid *scene, int dim, int halvings, vec3s camera,
                           int axis)
{
    const double cell = ldexp((double)scene->cell_m, -halvings), step = 4.0 * ceil(dim / 32.0);
    struct span s = { .scene = ldexp(scene->cells[axis], halvings), .step = step };
    s.most = fmax(s.scene - dim, 0.0);
    if (s.most > 0.0) s.step = fmin(step, s.most);
    const double at = ((double)camera.raw[axis] - (double)scene->origin_m.raw[axis]) / cell;
    s.centred = fmin(fmax(at - 0.5 * dim, 0.0), s.most);
    return s;
}

// At most half a step from the centred offset. Snaps to the border of the scene within half a step.
static double offset_of(const struct span *s)
{
    return s->centred > s->most - 0.5 * s->step ? s->most : s->step * round(s->centred / s->step);
}

struct vct_grid vct_grid_around(const struct vct_grid *scene, int dim, int halvings, vec3s camera)
{
    const double cell = ldexp((double)scene->cell_m, -halvings);
    struct vct_grid grid = { .cell_m = (float)cell };
    for (int axis = 0; axis < 3; axis++) {
        const struct span span = span_of(scene, dim, halvings, camera, axis);
        grid.scene[axis] = (int32_t)span.scene;
        grid.cells[axis] = grid.scene[axis] < dim ? grid.scene[axis] : dim;
        grid.first[axis] = (int32_t)offset_of(&span);
        grid.origin_m.raw[axis] =
            (float)((double)scene->origin_m.raw[axis] + grid.first[axis] * cell);
    }
    return grid;
}

// Distance of a side of the cone box from the scene's border, for a grid whose centred offset is
// `centred` voxels from it. The grid may be half a step farther, and its outermost voxel, half a
// texel, is excluded. Within half a step of the border, where the grid has snapped to it, the side
// moves continuously from there to `fade` voxels beyond the scene.
static double side_of(const struct span *s, double centred, double fade)
{
    const double half = 0.5 * s->step;
    return centred >= half ? centred + half + 1.0 : (s->step + 1.0 + fade) * centred / half - fade;
}

struct box3 vct_grid_cone_box(const struct vct_grid *scene, int dim, int halvings, vec3s camera,
                              float fade)
{
    struct box3 box;
    for (int axis = 0; axis < 3; axis++) {
        const struct span span = span_of(scene, dim, halvings, camera, axis);
        box.min.raw[axis] = (float)side_of(&span, span.centred, (double)fade);
        box.max.raw[axis] =
            (float)(span.scene - side_of(&span, span.most - span.centred, (double)fade));
    }
    return box;
}
