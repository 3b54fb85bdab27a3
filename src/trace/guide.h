// Path guiding: learned distributions of the light that arrives at surfaces (Müller, Gross & Novák
// 2017, "Practical Path Guiding for Efficient Light-Transport Simulation"). docs/reference.md
// describes the method.
//
// A spatial tree of cells holds directional quadtrees over hemispheres. The share of guided samples
// is chosen for each cell by the records that its distribution was not fitted to.
#pragma once

#include "trace/direction_tree.h"

#include "core/host.h"

// The distribution of one cell.
struct guide_cell {
    int axis;                           // of the surfaces, direction_axis
    float weight;                       // of guided samples against those of the diffuse lobe
    const struct direction_node *nodes; // NULL: not guided
    float radiance;                     // mean luminance that leaves the surfaces, cd/m²
};

// An inner node divides by position.raw[axis] at `split`; its second child follows the first. A
// leaf has axis 3.
struct guide_node {
    float split;
    uint32_t axis : 2, child : 30; // leaf: index of its cell
};

struct guide {
    struct guide_node *nodes; // the first six are the roots, in the order of direction_axis
    struct guide_cell *cells;
    struct direction_node *directions; // of all cells
    float radiance;                    // mean over the visits, as that of the cells
};

// The cell of a surface point; NULL without a guide.
static inline const struct guide_cell *guide_find(const struct guide *guide, vec3s position,
                                                  vec3s normal)
{
    if (!guide) return NULL;
    const struct guide_node *node = &guide->nodes[direction_axis(normal)];
    while (node->axis < 3)
        node = &guide->nodes[node->child + (position.raw[node->axis] < node->split ? 0u : 1u)];
    return &guide->cells[node->child];
}

static inline vec3s guide_sample(const struct guide_cell *cell, vec2s u)
{
    return direction_from_square(cell->axis, direction_tree_sample(cell->nodes, u));
}

// Density of guide_sample, 1/sr.
static inline float guide_pdf(const struct guide_cell *cell, vec3s direction)
{
    struct direction_point p;
    if (!direction_to_square(cell->axis, direction, &p)) return 0.0f;
    return direction_tree_density(cell->nodes, p.at) / p.sr;
}

// ---- fitting

// A visit of a surface by a path. The integrand and the densities are with respect to area on the
// square of the directions.
struct guide_record {
    vec3s position;
    int axis;
    float importance; // squared throughput of the path before, relative to the pixel's light
    float radiance;   // estimate of the luminance that leaves backwards along the path, cd/m²
    vec2s at;         // direction
    float reflected;  // the integrand, luminance; 0: no light was found
    float weight;     // of the irradiance, as direction_record
    float bsdf, all;  // densities of BSDF sampling and of the sample
    float share;      // of guided samples where the cell's weight is 1
};

// Fits a guide to records, which it reorders. *guide is NULL where no light was found. *gain: the
// variance of the records without the guide over that with it. False on failure.
bool guide_fit(struct host *host, struct guide_record *records, size_t count, struct guide **guide,
               double *gain);
void guide_destroy(struct host *host, struct guide *guide); // accepts NULL
