// The area of a triangle, in double precision: products of small edges do not underflow.
#pragma once

#include "core/vec.h"

#include <math.h>

// Also writes the unit normal. 0 for triangles without an area or with coordinates that are not
// finite.
static inline float triangle_area(const vec3s corner[3], vec3s *normal)
{
    double a[3], b[3], n[3];
    for (int k = 0; k < 3; k++) {
        a[k] = (double)corner[1].raw[k] - (double)corner[0].raw[k];
        b[k] = (double)corner[2].raw[k] - (double)corner[0].raw[k];
    }
    for (int k = 0; k < 3; k++)
        n[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const float area = (float)(0.5 * length);
    *normal = vec3_of(0.0f, 1.0f, 0.0f);
    if (!(area > 0.0f) || !isfinite(area)) return 0.0f;
    *normal = vec3_of((float)(n[0] / length), (float)(n[1] / length), (float)(n[2] / length));
    return area;
}
