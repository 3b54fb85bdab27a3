// Charts of a surface at a density: which triangles each one has, and where they are on its plane.
#pragma once

#include "scene/charts/surface.h"

struct grown_chart {
    uint32_t first_triangle, triangle_count; // in `order`
    bool unwrapped, single_texel; // single_texel: one texel, whose centre all corners are at
    vec3s normal;
    double width, height; // texels; the least coordinates of the corners are 0
};

struct grown {
    struct host *host;
    uint32_t *order;       // [surface->count], chart after chart
    uint32_t *chart_of;    // [surface->count]
    double (*place)[3][2]; // [surface->count] of the corners on the chart, in texels
    struct grown_chart *charts;
    uint32_t count;
};

// grown_finish accepts zero.
bool grow_charts(struct grown *out, struct host *host, const struct surface *surface,
                 double texels_per_m);
void grown_finish(struct grown *grown);
