// Seams: edges at which two charts meet and the surface is smooth. Bilinear lookups of both charts
// differ there, since their texels do. Points along the edges say by how much: the difference is a
// weighted sum of eight places of the light map. Made of the charts alone.
#pragma once

#include "techniques/radiosity/radiosity_map.h"

enum {
    RADIOSITY_SEAM_PLACES = 8,
    RADIOSITY_SEAM_ENTRIES = 16, // texels whose sum a place shows, at most
};

struct radiosity_seam_point {
    uint32_t place[RADIOSITY_SEAM_PLACES]; // in `places`: four of each chart
    float weight[RADIOSITY_SEAM_PLACES];   // bilinear; negative ones are of the second chart
    float length;                          // of its part of the edge, in texels
    vec3s position;                        // world
    uint32_t triangle[2];                  // in charts.triangles
    bool back;
};

struct radiosity_seams {
    struct host *host;
    struct radiosity_seam_point *points;
    uint32_t point_count;
    uint32_t *places; // (side · height + y) · width + x in the light map
    uint32_t count;   // of places
};

// per_texel: points along a texel of the edge. radiosity_seams_finish accepts zero.
bool radiosity_seams_init(struct radiosity_seams *out, const struct radiosity_map *map,
                          float per_texel);
void radiosity_seams_finish(struct radiosity_seams *seams);

// Points that the closing of seams makes equal.
#define RADIOSITY_SEAM_POINTS 4.0f
