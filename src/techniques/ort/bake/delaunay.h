// Delaunay triangulation of points in the plane, by Qhull: the lower side of the convex hull of the
// points lifted to a paraboloid.
#pragma once

#include "core/host.h"

#include <stdint.h>

struct ort_triangles {
    uint32_t (*corners)[3]; // indices of points, counter-clockwise
    uint32_t count;
};

// Triangulates the convex hull of `count` distinct points at (at[2i], at[2i + 1]), all finite.
// Triangles share whole edges; none has an area of 0. Of cocircular points any triangulation is
// Delaunay: Qhull's choice depends on the points and their order alone.
// FAIL_ARGUMENT: fewer than 3 points, points on a line, or points so close together that Qhull
// leaves one out (groups with distances of about 1e-7 of the extent, or of integers beyond 2^16).
// Calls on several threads are safe. Qhull's own memory is that of the C library.
bool ort_delaunay(struct host *host, const double *at, uint32_t count, struct ort_triangles *out);
void ort_triangles_finish(struct host *host, struct ort_triangles *triangles); // accepts zero
