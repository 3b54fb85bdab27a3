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

// ---- Parts about the eye ------------------------------------------------------------------------

// A part along an axis, in its voxels from the scene's corner.
struct span {
    double scene; // voxels of the scene
    double most;  // where it may begin at most
    double wish;  // where it would begin if it did not go in steps
    double step; // between places where it may begin; texels of the next coarser part are four wide
};

static struct span span_of(const struct vct_grid *scene, int dim, int halvings, vec3s eye, int axis)
{
    const double cell = ldexp((double)scene->cell_m, -halvings), step = 4.0 * ceil(dim / 32.0);
    struct span s = { .scene = ldexp(scene->cells[axis], halvings), .step = step };
    s.most = fmax(s.scene - dim, 0.0);
    if (s.most > 0.0) s.step = fmin(step, s.most);
    const double at = ((double)eye.raw[axis] - (double)scene->origin_m.raw[axis]) / cell;
    s.wish = fmin(fmax(at - 0.5 * dim, 0.0), s.most);
    return s;
}

// Half a step away from where it wishes to be at most; and on a border of the scene that is nearer
// than that.
static double begin_of(const struct span *s)
{
    return s->wish > s->most - 0.5 * s->step ? s->most : s->step * round(s->wish / s->step);
}

struct vct_grid vct_grid_around(const struct vct_grid *scene, int dim, int halvings, vec3s eye)
{
    const double cell = ldexp((double)scene->cell_m, -halvings);
    struct vct_grid grid = { .cell_m = (float)cell };
    for (int axis = 0; axis < 3; axis++) {
        const struct span span = span_of(scene, dim, halvings, eye, axis);
        grid.scene[axis] = (int32_t)span.scene;
        grid.cells[axis] = grid.scene[axis] < dim ? grid.scene[axis] : dim;
        grid.first[axis] = (int32_t)begin_of(&span);
        grid.origin_m.raw[axis] =
            (float)((double)scene->origin_m.raw[axis] + grid.first[axis] * cell);
    }
    return grid;
}

// How far a side of what is used is from the scene's border, where the part wishes to be `wish`
// voxels from it. The part may be half a step nearer or farther, and its outermost half texel, one
// voxel, is not used. What wishes to be within half a step of the border is there: there the side
// moves on out of the scene.
static double side_of(const struct span *s, double wish, double fade)
{
    const double half = 0.5 * s->step;
    return wish >= half ? wish + half + 1.0 : (s->step + 1.0 + fade) * wish / half - fade;
}

struct box3 vct_grid_cone_box(const struct vct_grid *scene, int dim, int halvings, vec3s eye,
                              float fade)
{
    struct box3 used;
    for (int axis = 0; axis < 3; axis++) {
        const struct span span = span_of(scene, dim, halvings, eye, axis);
        used.min.raw[axis] = (float)side_of(&span, span.wish, (double)fade);
        used.max.raw[axis] =
            (float)(span.scene - side_of(&span, span.most - span.wish, (double)fade));
    }
    return used;
}
