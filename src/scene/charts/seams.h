// Seams: edges at which two charts meet and the surface is smooth. Bilinear lookups of both charts
// differ there, since their texels do. The difference at points along the edges is a weighted sum
// of eight places of the light map. It depends on the charts alone.
#pragma once

#include "scene/charts/charts.h"

enum {
    CHART_SEAM_PLACES = 8,
    CHART_SEAM_ENTRIES = 16, // texels whose sum a place shows, at most
};

// An entry of a weighted sum of texels.
struct chart_share {
    uint32_t texel;
    float weight;
};

struct chart_seam_point {
    uint32_t place[CHART_SEAM_PLACES]; // in `places`: four of each chart
    float weight[CHART_SEAM_PLACES];   // bilinear; negative ones are of the second chart
    float length;                      // of its part of the edge, in texels
    vec3s position;                    // world
    uint32_t triangle[2];              // in charts.triangles
    bool back;
};

struct chart_seams {
    struct host *host;
    struct chart_seam_point *points;
    uint32_t point_count;
    uint32_t *places; // (side · height + y) · width + x in the light map
    uint32_t count;   // of places
};

// per_texel: points along a texel of the edge. charts_seams_finish accepts zero.
bool charts_seams_init(struct chart_seams *out, const struct charts *charts, float per_texel);
void charts_seams_finish(struct chart_seams *seams);

// Points that the closing of seams makes equal.
#define CHART_SEAM_POINTS 4.0f
