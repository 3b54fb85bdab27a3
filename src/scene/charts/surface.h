// The chosen triangles of a pose, and which of them meet at an edge.
#pragma once

#include "scene/charts/charts.h"

struct surface_triangle {
    int instance;
    uint32_t triangle;
    vec3s corner[3];
    vec3s vertex_normal[3]; // as in chart_triangle
    vec3s normal;           // unit, of the front
    float area_m2;
    bool double_sided;
    bool unwrapped; // uv is that of a valid unwrap, and edges connect where it is equal
    vec2s uv[3];
    uint32_t neighbor[3]; // across the edge from corner k to k + 1; CHART_NONE: none
};

struct surface {
    struct host *host;
    struct surface_triangle *triangles;
    uint32_t count;
    uint32_t without_area;   // chosen ones that were left out
    double area_m2, edges_m; // sum of areas, of all edges' lengths
    float longest_m;
};

// chosen: as in charts_options. surface_finish accepts zero.
bool surface_init(struct surface *out, struct host *host, const struct scene_pose *pose,
                  const bool *chosen, enum charts_coordinates coordinates);
void surface_finish(struct surface *surface);
