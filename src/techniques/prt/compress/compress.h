// Compression of points by clusters of affine subspaces (Sloan, Hall, Hart & Snyder 2003,
// "Clustered Principal Components for Precomputed Radiance Transfer"; Hong 2015, section 2.5.1.5):
// a point is the mean of its cluster plus a weighted sum of the cluster's vectors,
//
//     x ≈ m_c + Σ w_k b_ck,  w_k = b_ck · (x − m_c).
//
// Without vectors this is vector quantisation, with one cluster principal component analysis.
#pragma once

#include "core/linalg.h"

#include <stdint.h>

struct prt_points {
    const float *at; // [count][dim]
    size_t count, dim;
};

struct prt_compression {
    uint32_t clusters; // at least 1
    uint32_t vectors;  // of a cluster, at most the dimension
    uint64_t seed;
    bool (*stop)(void *user); // polled every few milliseconds; NULL: never
    void *user;
};

// prt_codebook_finish accepts zero.
struct prt_codebook {
    struct host *host;
    size_t clusters, vectors, dim;
    float *rows;       // [clusters][1 + vectors][dim]: mean, then orthonormal vectors
    uint32_t *cluster; // [points]
    double error;      // Σ |x − x̂|² over the points
};

// Clusters by vector quantisation: seeds by their squared distances (Arthur & Vassilvitskii 2007,
// "k-means++"), then Lloyd's rounds. With vectors, rounds follow in which points move to the
// subspace nearest to them. Points of many numbers are clustered in the space of their 128 largest
// principal vectors; means and vectors are then those of the whole points. Deterministic. False: no
// memory, or stopped (FAIL_CANCELLED).
bool prt_compress(struct host *host, const struct prt_points *points,
                  const struct prt_compression *how, struct prt_codebook *out);
void prt_codebook_finish(struct prt_codebook *codebook);
static inline const float *prt_codebook_row(const struct prt_codebook *codebook, size_t cluster,
                                            size_t row)
{
    return codebook->rows + (cluster * (1 + codebook->vectors) + row) * codebook->dim;
}

// [vectors] of a point in a cluster.
void prt_weigh(const struct prt_codebook *codebook, uint32_t cluster, const float *point,
               float *weights);
// Σ |x − mean|² of the points.
double prt_variance(const struct prt_points *points);

// ---- for compress.c: lloyd.c, seeds.c, reduce.c

// Points around 0 in fewer numbers, with orthonormal columns of `basis`; none, where they have few
// already. prt_reduction_finish accepts zero.
struct prt_reduction {
    struct host *host;
    struct matrix_f32 basis;  // [dim][numbers]
    struct matrix_f32 points; // [count][numbers]
};
bool prt_reduce(struct host *host, const struct prt_points *points,
                const struct prt_compression *how, struct prt_reduction *out);
// The codebook of reduced points becomes one of whole points.
bool prt_expand(const struct prt_reduction *reduction, struct prt_codebook *codebook);
void prt_reduction_finish(struct prt_reduction *reduction);

// The nearest subspace of each point and the squared distances to them, [count].
bool prt_assign(const struct prt_points *points, const struct prt_compression *how,
                struct prt_codebook *codebook, float *error);
// Means and vectors of the points of each cluster.
bool prt_update(const struct prt_points *points, struct prt_codebook *codebook);
// Means of the clusters.
bool prt_find_seeds(const struct prt_points *points, const struct prt_compression *how,
                    struct prt_codebook *codebook);
static inline bool prt_stopped(struct host *host, const struct prt_compression *how)
{
    return how->stop && how->stop(how->user) && !host_fail(host, FAIL_CANCELLED, "cancelled");
}
