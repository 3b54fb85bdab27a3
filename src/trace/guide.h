// Guided rays: learned distributions of near light, that is sky seen from a surface and punctual
// light reflected once towards it. docs/reference.md describes the method.
//
// As in path guiding (Müller, Gross & Novák 2017, "Practical Path Guiding for Efficient
// Light-Transport Simulation"), a spatial tree of cells holds directional quadtrees. Here they do
// not guide the path but a second ray from each vertex, combined with BSDF sampling by multiple
// importance sampling: near light is found without noise in the light itself.
#pragma once

#include "trace/direction_tree.h"

#include "core/host.h"

// The distribution of one cell.
struct guide_cell {
    int axis;                           // of the surfaces, direction_axis
    const struct direction_node *nodes; // NULL: no guided rays
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
};

// The cell of a surface point; NULL where there are no guided rays. guide: may be NULL.
static inline const struct guide_cell *guide_find(const struct guide *guide, vec3s position,
                                                  vec3s normal)
{
    if (!guide) return NULL;
    const struct guide_node *node = &guide->nodes[direction_axis(normal)];
    while (node->axis < 3)
        node = &guide->nodes[node->child + (position.raw[node->axis] < node->split ? 0u : 1u)];
    const struct guide_cell *cell = &guide->cells[node->child];
    return cell->nodes ? cell : NULL;
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

// A visit of a surface by a path, or near light that a guided ray found. The integrand and the
// densities are with respect to area on the square of the directions.
struct guide_record {
    vec3s position;
    int axis;
    bool visit;
    float importance; // of a visit: squared throughput of the path before
    vec2s at;         // direction
    float reflected;  // the integrand, luminance; 0: no light was found
    float moment;     // of the irradiance, as direction_record
    float bsdf, all;  // densities of BSDF sampling and of both techniques together
};

// Fits a guide to records, which it reorders. ray_cost: time of a guided ray,
// relative to that of a path's step; guided rays are kept where they reduce the product of variance
// and time; 0: wherever near light was found. *guide is NULL where they nowhere do. False
// on failure.
bool guide_fit(struct host *host, struct guide_record *records, size_t count, double ray_cost,
               struct guide **guide);
void guide_destroy(struct host *host, struct guide *guide); // accepts NULL
