// Planes of large axis-aligned surfaces, from rays along the axes.
#include "map_cells.h"

#include "core/saturate.h"

#include <math.h>
#include <string.h>

enum { LINES = 48, BINS = 256, MAX_HITS = 64 };
static const float ALIGNED = 0.9f; // cosine between a surface's normal and the axis
static const float LARGE = 0.08f;  // least surface, of the cross-section of the scene
static const float APART = 0.03f;  // least distance of planes, of the longest edge of the scene

struct histogram {
    float share[BINS], sum[BINS]; // of the cross-section; Σ share · position
};

// All surfaces along one line.
static void add_line(const struct mrt_cells *cells, int axis, vec3s from, struct histogram *out)
{
    float low = cells->bounds.min.raw[axis], size = cells->bounds.max.raw[axis] - low;
    vec3s along = vec3_of(0, 0, 0);
    along.raw[axis] = 1.0f;
    for (int i = 0; i < MAX_HITS; i++) {
        struct raycast_hit hit;
        float left = cells->bounds.max.raw[axis] + 1e-3f * size - from.raw[axis];
        if (!raycast_closest(cells->raycast, from, along, left, &hit)) return;
        from.raw[axis] += hit.distance;
        if (fabsf(hit.normal.raw[axis]) >= ALIGNED) {
            float share = 1.0f / (float)(LINES * LINES);
            const float at = (from.raw[axis] - low) / size * (float)BINS;
            const int bin = int_saturated((double)at, 0, BINS - 1);
            out->share[bin] += share;
            out->sum[bin] += share * from.raw[axis];
        }
        from.raw[axis] += 1e-5f * size;
    }
}

static void add_lines(const struct mrt_cells *cells, int axis, struct histogram *out)
{
    memset(out, 0, sizeof *out);
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    vec3s size = box3_size(cells->bounds);
    for (int i = 0; i < LINES * LINES; i++) {
        vec3s from = cells->bounds.min;
        from.raw[u] += size.raw[u] * ((float)(i % LINES) + 0.5f) / (float)LINES;
        from.raw[v] += size.raw[v] * ((float)(i / LINES) + 0.5f) / (float)LINES;
        from.raw[axis] -= 1e-3f * size.raw[axis];
        add_line(cells, axis, from, out);
    }
}

static void add_plane(struct mrt_cells *cells, int axis, float position)
{
    int i = cells->planes[axis]++;
    for (; i > 0 && cells->plane[axis][i - 1] > position; i--)
        cells->plane[axis][i] = cells->plane[axis][i - 1];
    cells->plane[axis][i] = position;
}

static bool near_plane(const struct mrt_cells *cells, int axis, float position)
{
    vec3s size = box3_size(cells->bounds);
    float apart = APART * glms_vec3_max(size);
    for (int i = 0; i < cells->planes[axis]; i++)
        if (fabsf(cells->plane[axis][i] - position) < apart) return true;
    return false;
}

// The largest surfaces first; those near an earlier plane are the other side of the same wall.
static void pick_planes(struct mrt_cells *cells, int axis, const struct histogram *histogram)
{
    bool taken[BINS] = { false };
    while (cells->planes[axis] < MRT_MAX_PLANES) {
        int best = -1;
        float most = LARGE;
        for (int i = 0; i < BINS; i++) {
            // Bins have borders: two neighbours count together.
            float share = histogram->share[i] + (i + 1 < BINS ? histogram->share[i + 1] : 0.0f);
            if (taken[i] || share <= most) continue;
            most = share;
            best = i;
        }
        if (best < 0) return;
        taken[best] = true;
        float sum = histogram->sum[best] + (best + 1 < BINS ? histogram->sum[best + 1] : 0.0f);
        if (!near_plane(cells, axis, sum / most)) add_plane(cells, axis, sum / most);
    }
}

void mrt_cells_find_planes(struct mrt_cells *cells)
{
    for (int axis = 0; axis < 3; axis++) {
        struct histogram histogram;
        cells->planes[axis] = 0;
        add_plane(cells, axis, cells->bounds.min.raw[axis]);
        add_plane(cells, axis, cells->bounds.max.raw[axis]);
        add_lines(cells, axis, &histogram);
        pick_planes(cells, axis, &histogram);
    }
}
