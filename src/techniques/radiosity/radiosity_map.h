// The texels of the light map and the clusters that send light, both made of a pose's triangles
// alone, but for the parts: the same pose gives the same texels.
//
// Charts (scene/charts) have texels on the front of their triangles; those of double-sided
// materials have as many again on the back. A cluster is a square of a chart's texels on one side,
// or one of two parts of it, which a wall on the chart divides: a source of diffuse light with one
// radiosity. Parts are found by rays.
#pragma once

#include "scene/charts/charts.h"

#include "techniques/radiosity/radiosity_options.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_tree.h"

struct radiosity_texel {
    uint32_t chart_texel; // in charts.texels
    uint32_t cluster;
    vec3s normal; // of its side
    bool back;
};

struct radiosity_map {
    struct host *host;
    struct charts charts;
    struct radiosity_texel *texels; // fronts, in the order of charts.texels; then backs
    uint32_t texel_count;
    uint32_t *back_of; // [charts.count] the first texel of a chart's back; CHART_NONE: it has none
    uint32_t edge;     // of a cluster's square, texels
    uint32_t cluster_count;
    struct radiosity_tree tree; // of the clusters, which are numbered as its leaves
    uint32_t *first;            // [cluster_count + 1] of the cluster, in `members`
    uint32_t *members;          // [texel_count] texels, cluster after cluster
    size_t *triangle_0;         // [instances + 1] first triangle of an instance, in chart_triangle
    uint32_t *chart_triangle;   // [triangles of the scene] in charts.triangles; CHART_NONE: no area
};

// A tree has less than twice as many nodes as clusters. radiosity_map_finish accepts zero.
enum { RADIOSITY_MAX_CLUSTERS = 1 << (RADIOSITY_NODE_BITS - 1) };
// Their charts alone.
bool radiosity_charts_init(struct charts *out, struct host *host, const struct scene_pose *pose,
                           const struct radiosity_options *options);
bool radiosity_map_init(struct radiosity_map *out, struct host *host, const struct scene_pose *pose,
                        const struct radiosity_options *options);
// Makes the clusters again, with the part of each texel, 0 or 1: at most twice as many.
bool radiosity_map_divide(struct radiosity_map *map, const uint8_t *part);
void radiosity_map_finish(struct radiosity_map *map);

static inline const struct chart_texel *radiosity_chart_texel(const struct radiosity_map *map,
                                                              uint32_t texel)
{
    return &map->charts.texels[map->texels[texel].chart_texel];
}
// The texel at a point of a triangle; CHART_NONE: the triangle has no area, or no back.
uint32_t radiosity_texel_at(const struct radiosity_map *map, int instance, uint32_t triangle,
                            float u, float v, bool back);
// The texel of a place of the light map, (side · height + y) · width + x; CHART_NONE: none.
uint32_t radiosity_texel_of_place(const struct radiosity_map *map, size_t place);
// [texel_count] the texel whose light each one shows: itself, or where `hidden` the nearest of the
// same side of its chart that is not; itself where all are. Owned by the caller.
uint32_t *radiosity_fill(const struct radiosity_map *map, const bool *hidden);
