// First means: points drawn by their squared distance to the nearest one that is drawn already.
#include "techniques/prt/compress/compress.h"

#include "core/rng.h"

#include <math.h>
#include <string.h>

static double distance2(const float *a, const float *b, size_t dim)
{
    double sum = 0.0;
    for (size_t i = 0; i < dim; i++) {
        const double d = (double)(a[i] - b[i]);
        sum += d * d;
    }
    return sum;
}

// The point where the running sum of weights passes `target`; of no weights the last.
static size_t draw(const double *weight, size_t count, double target)
{
    for (size_t i = 0; i + 1 < count; i++) {
        target -= weight[i];
        if (target < 0.0) return i;
    }
    return count - 1;
}

bool prt_find_seeds(const struct prt_points *points, const struct prt_compression *how,
                    struct prt_codebook *codebook)
{
    const size_t dim = points->dim, stride = (1 + codebook->vectors) * dim;
    struct rng rng = rng_for((uint32_t)how->seed, (uint32_t)(how->seed >> 32), 0);
    double *nearest = host_alloc(codebook->host, points->count, sizeof *nearest);
    if (!nearest) return false;
    for (size_t i = 0; i < points->count; i++) nearest[i] = INFINITY;
    size_t next = (size_t)(rng_double(&rng) * (double)points->count);
    bool ok = true;
    for (size_t c = 0; ok && c < codebook->clusters; c++) {
        float *mean = codebook->rows + c * stride;
        double sum = 0.0;
        memcpy(mean, points->at + next * dim, dim * sizeof *mean);
        for (size_t i = 0; i < points->count; i++) {
            nearest[i] = fmin(nearest[i], distance2(points->at + i * dim, mean, dim));
            sum += nearest[i];
        }
        next = draw(nearest, points->count, rng_double(&rng) * sum);
        ok = !prt_stopped(codebook->host, how);
    }
    host_free(codebook->host, nearest);
    return ok;
}
