// The charts of the light map and the clusters that send light, both made of a pose's triangles
// alone, but for the parts: the same pose gives the same texels.
//
// Texels are those of both sides of the charts (scene/charts). A cluster is a square of a chart's
// texels on one side, or one of two parts of it, which a wall on the chart divides: a source of
// diffuse light with one radiosity. Parts are found by rays.
#pragma once

#include "scene/charts/charts.h"

#include "techniques/radiosity/radiosity_options.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_tree.h"

struct radiosity_map {
    struct host *host;
    struct charts charts;
    uint32_t texel_count; // of both sides of the charts
    uint32_t edge;        // of a cluster's square, texels
    uint32_t cluster_count;
    uint32_t *cluster_of;       // [texel_count]
    struct radiosity_tree tree; // of the clusters, which are numbered as its leaves
    uint32_t *first;            // [cluster_count + 1] of the cluster, in `members`
    uint32_t *members;          // [texel_count] texels, cluster after cluster
};

// A tree has less than twice as many nodes as clusters. radiosity_map_finish accepts zero.
enum { RADIOSITY_MAX_CLUSTERS = 1 << (RADIOSITY_NODE_BITS - 1) };
// Their charts alone.
bool radiosity_charts(const struct scene_pose *statics, const void *options, struct host *host,
                      const struct charts_search *begin, struct charts *out);
bool radiosity_map_init(struct radiosity_map *out, struct host *host, const struct scene_pose *pose,
                        const struct radiosity_options *options);
// Makes the clusters again, with the part of each texel, 0 or 1: at most twice as many.
bool radiosity_map_subdivide(struct radiosity_map *map, const uint8_t *part);
void radiosity_map_finish(struct radiosity_map *map);
