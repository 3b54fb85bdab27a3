// Receivers: the points that have transfer vectors, texels of a light map or vertices. Those of
// all fronts come first, then those of the backs of double-sided materials.
#pragma once

#include "scene/charts/charts.h"
#include "techniques/prt/prt_options.h"
#include "techniques/prt/receivers/vertices.h"

// The charts of the light map that has the texels.
bool prt_charts(const struct scene_pose *statics, const void *options, struct host *host,
                const struct charts_search *begin, struct charts *out);

struct prt_receivers {
    struct host *host;
    bool at_vertices;
    uint32_t count;               // of both sides
    struct charts *charts;        // of texels; empty at vertices
    struct prt_vertices vertices; // empty at texels
};

// charts: memory for them, which stays where it is until prt_receivers_finish; that accepts zero.
// False: host_fail has the reason, as where options do not fit.
bool prt_receivers_init(struct prt_receivers *out, struct charts *charts, struct host *host,
                        const struct scene_pose *statics, const struct prt_options *options);
void prt_receivers_finish(struct prt_receivers *receivers);

struct box3 prt_receivers_bounds(const struct prt_receivers *receivers);

// Unit, of its side: of a texel's triangle, of a vertex the shading normal.
vec3s prt_receiver_normal(const struct prt_receivers *receivers, uint32_t receiver);

// A point of a triangle of an instance's mesh.
struct prt_point {
    int instance;
    uint32_t triangle;
    float u, v; // weights of the second and third corner
    bool back;
};
// The receiver whose light a point sends: its texel, or one of the triangle's vertices, each with
// the probability of its weight, by `choice` in [0, 1). CHART_NONE: none.
uint32_t prt_receiver_at(const struct prt_receivers *receivers, const struct prt_point *point,
                         float choice);

// [count] nearest valid receiver of each (charts_fill, prt_vertices_fill): hidden ones have no
// share. point: [count][4] position and share. Owned by the caller.
uint32_t *prt_receivers_nearest_valid(const struct prt_receivers *receivers, const float *point);
