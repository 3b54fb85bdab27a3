// A hierarchy of the clusters, by which a row of form factors is made short: there is one entry for
// each cluster that its rays meet, and if only the largest entries were kept, which ones these are
// would be chance. The nodes of a binary tree are strata instead: each one is an entry, of one of
// the groups in it that were hit.
//
// A group is a node of a few clusters, which are near to each other and face one way. It is a
// source with their mean radiosity. Larger nodes are not: they have both sides of walls.
#pragma once

#include "core/host.h"
#include "core/vec.h"

#include <stdint.h>

#define RADIOSITY_NO_NODE UINT32_MAX

// Nodes 0 … leaves − 1 are the clusters, in the order of the tree.
struct radiosity_node {
    uint32_t first, count; // clusters
    uint32_t parent;       // RADIOSITY_NO_NODE: of the root
    uint32_t child[2];     // RADIOSITY_NO_NODE: of a cluster
};

enum { RADIOSITY_GROUP = 8 }; // clusters at most

struct radiosity_tree {
    struct host *host;
    struct radiosity_node *nodes;
    uint32_t count, leaves;
};

// Position and normal of a cluster.
struct radiosity_place {
    vec3s position, normal;
};

// order: [leaves] which of the places each leaf is.
bool radiosity_tree_init(struct radiosity_tree *out, struct host *host,
                         const struct radiosity_place *places, uint32_t leaves, uint32_t *order);
void radiosity_tree_finish(struct radiosity_tree *tree); // accepts zero
