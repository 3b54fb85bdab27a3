// The receivers of bounced light: groups of clusters. Light that has bounced twice varies slowly,
// so that a group receives one irradiance; its clusters reflect it with their own reflectances.
//
// A group is the largest node of the tree that rows of the bake have, whose clusters therefore see
// each other, or one cluster.
#pragma once

#include "techniques/radiosity/radiosity_map.h"
#include "techniques/radiosity/radiosity_shared.h"

struct radiosity_groups {
    struct host *host;
    struct radiosity_gpu_group *groups;
    uint32_t count;
    uint32_t entries;      // of a row
    uint32_t *of;          // [clusters] the group of each
    uint32_t *source;      // [entry][group]: group
    float *factor;         // [entry][group]: share of the cosine-weighted hemisphere
    float spectral_radius; // of ρ F, at least
};

// Rows of clusters as a bake has them: nodes of the tree and 16-bit factors.
struct radiosity_cluster_rows {
    const uint32_t *source;
    const uint16_t *factor;
    size_t entries;
};

// clusters: [map->cluster_count]; most: entries of a row. radiosity_groups_finish accepts zero.
bool radiosity_groups_init(struct radiosity_groups *out, const struct radiosity_map *map,
                           const struct radiosity_gpu_cluster *clusters,
                           const struct radiosity_cluster_rows *rows, uint32_t most);
void radiosity_groups_finish(struct radiosity_groups *groups);
