// A sparse row of form factors.
#pragma once

#include "techniques/radiosity/bake/gather.h"

struct radiosity_entry {
    uint32_t node;                  // of the tree
    struct radiosity_factor factor; // `along` per weight
};

// Scratch memory of a task that makes rows. radiosity_rows_finish accepts zero.
struct radiosity_rows {
    struct host *host;
    const struct radiosity_tree *tree;
    const bool *is_group;         // [nodes]
    struct radiosity_factor *sum; // [nodes] of the clusters that rays hit; all 0 between the calls
    uint32_t *touched;            // [nodes] those that are not
    struct radiosity_entry *heap;
    struct radiosity_entry *cut; // [nodes] the result of a refinement
    uint32_t *stratum;           // [nodes] 1 + number of the stratum; 0: none
    uint32_t *stratum_node;      // [nodes] of each stratum
    uint32_t stratum_count;
};
bool radiosity_rows_init(struct radiosity_rows *rows, struct host *host,
                         const struct radiosity_scene *scene);
void radiosity_rows_finish(struct radiosity_rows *rows);

// Writes at most `most` entries and returns their number: from the root downwards the heaviest node
// is replaced by its children while there are spare entries. Of a node larger than a group a group
// in it stands for all, chosen by weight: the sum of the row is exact, and its light is without
// bias. phase: 0…1, where in the nodes' weights the groups are: neighbours with phases of a
// low-discrepancy sequence choose groups that complement each other.
uint32_t radiosity_make_row(struct radiosity_rows *rows, const struct radiosity_gather *gather,
                            uint32_t most, float phase, struct radiosity_entry *out);

// A source of a stratum, and its share of the stratum's light.
struct radiosity_share {
    uint32_t node, stratum;
    float share;
};

// Strata of neighbouring texels, found from the sum of what their rays meet: at most `strata` nodes
// by the refinement of a row, and at most `most` sources below them, by the same refinement.
// Returns the number of sources. The strata stay until radiosity_clear_strata.
uint32_t radiosity_make_strata(struct radiosity_rows *rows, const struct radiosity_gather *sum,
                               uint32_t strata, uint32_t most, float phase,
                               struct radiosity_share *out);
// The stratum of a cluster of that sum.
uint32_t radiosity_stratum_of(const struct radiosity_rows *rows, uint32_t cluster);
void radiosity_clear_strata(struct radiosity_rows *rows);
