// A piecewise constant distribution of directions: a quadtree over a square that holds a hemisphere
// (Müller, Gross & Novák 2017, "Practical Path Guiding for Efficient Light-Transport Simulation",
// sec. 3.2).
//
// The paper maps the sphere by cylindrical coordinates. Here the hemisphere around a coordinate
// axis is mapped by the octahedron (Cigolle et al. 2014, "A Survey of Efficient Representations for
// Independent Unit Vectors", hemi-oct), without trigonometry.
#pragma once

#include "core/vec.h"

#include <stdint.h>

enum { DIRECTION_TREE_NODES = 64, DIRECTION_TREE_DEPTH = 7 };

// Children by x + 2y. child: 0 for a leaf, else the index of its node.
struct direction_node {
    float share[4]; // probability of each child, given the node
    uint16_t child[4];
};

// The axes +x +y +z −x −y −z; that of a normal is the nearest.
static inline int direction_axis(vec3s normal)
{
    float x = fabsf(normal.x), y = fabsf(normal.y), z = fabsf(normal.z);
    int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    return normal.raw[axis] < 0.0f ? axis + 3 : axis;
}

// A direction on the unit square, and the ratio of its solid angle to its area there, sr. False
// outside the hemisphere.
struct direction_point {
    vec2s at;
    float sr;
};
static inline bool direction_to_square(int axis, vec3s direction, struct direction_point *out)
{
    int a = axis < 3 ? axis : axis - 3;
    float z = axis < 3 ? direction.raw[a] : -direction.raw[a];
    if (!(z > 0.0f)) return false;
    float x = direction.raw[a == 2 ? 0 : a + 1], y = direction.raw[a == 0 ? 2 : a - 1];
    float sum = fabsf(x) + fabsf(y) + z, scale = 0.5f / sum;
    out->at = (vec2s){ { 0.5f + scale * (x + y), 0.5f + scale * (x - y) } };
    // The point q = d/|d|₁ lies on a face of the octahedron. Its projection onto the equator has
    // the area |q|³ per steradian, and the unit square half of the diamond's area.
    out->sr = 2.0f * sum * sum * sum;
    return true;
}
vec3s direction_from_square(int axis, vec2s at);

// Density over the unit square.
static inline float direction_tree_density(const struct direction_node *nodes, vec2s at)
{
    float density = 1.0f;
    for (uint16_t i = 0;;) {
        float x = 2.0f * at.x, y = 2.0f * at.y;
        int right = x >= 1.0f, upper = y >= 1.0f;
        const struct direction_node *node = &nodes[i];
        density *= 4.0f * node->share[right + 2 * upper];
        i = node->child[right + 2 * upper];
        if (i == 0) return density;
        at = (vec2s){ { x - (float)right, y - (float)upper } };
    }
}
// A point of that density from a point of the unit square.
vec2s direction_tree_sample(const struct direction_node *nodes, vec2s u);

// A sample of the function to approximate. weight: its value over the density of the sample, both
// with respect to area on the square.
struct direction_record {
    vec2s at;
    float weight;
};
// Fits a tree to the records, which it reorders, and returns the number of nodes, at most
// DIRECTION_TREE_NODES; 0 without any weight. The density is proportional to the function.
int direction_tree_fit(struct direction_record *records, int count, struct direction_node *nodes);
