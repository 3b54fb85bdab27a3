#include "techniques/prt/bake/lobes.h"

#include "core/linalg.h"
#include "core/rng.h"
#include "core/sh.h"
#include "trace/bsdf.h"

#include <math.h>

enum { OUTGOING_DIRECTIONS = 512 };

// The first lobe, and the last minus it.
static const float LEAST = (float)PRT_LEAST_ROUGHNESS, RANGE = 1.0f - (float)PRT_LEAST_ROUGHNESS;
static const vec3s UP = { { 0.0f, 0.0f, 1.0f } };

// The quadrature over outgoing directions: even in the solid angle.
static vec3s outgoing_direction(uint32_t i)
{
    return sample_hemisphere_uniform(sobol_2d(i, 0));
}

// ---- the dual basis

// Mean of y_k y_j over the quadrature.
static void add_products(const float *y, struct matrix_f64 *gram)
{
    for (size_t k = 0; k < PRT_OUTGOING; k++)
        for (size_t j = 0; j < PRT_OUTGOING; j++)
            gram->at[k * gram->stride + j] += (double)(y[k] * y[j]) / OUTGOING_DIRECTIONS;
}

// Functions that are almost 0 on the hemisphere have almost no weight.
static double eigenvalue(const struct linalg_eigen *eigen, size_t i)
{
    static const double RIDGE = 1e-4;
    return fmax(eigen->values[i], 0.0) + RIDGE * eigen->values[0];
}

// An entry of the power of a symmetric matrix.
static double power_entry(const struct linalg_eigen *eigen, double exponent, size_t k, size_t j)
{
    double sum = 0.0;
    for (size_t e = 0; e < PRT_OUTGOING; e++)
        sum += eigen->vectors.at[k * eigen->vectors.stride + e] *
               eigen->vectors.at[j * eigen->vectors.stride + e] *
               pow(eigenvalue(eigen, e), exponent);
    return sum;
}

// Sums over the hemisphere, of solid angle 2π, are 2π times the means of the quadrature.
static void fill_powers(const struct linalg_eigen *eigen, struct prt_lobes *lobes,
                        struct matrix_f64 *inverse)
{
    const double area = sqrt(2.0 * GLM_PI);
    for (size_t k = 0; k < PRT_OUTGOING; k++)
        for (size_t j = 0; j < PRT_OUTGOING; j++) {
            inverse->at[k * inverse->stride + j] = power_entry(eigen, -1.0, k, j);
            lobes->root[k][j] = (float)(power_entry(eigen, 0.5, k, j) * area);
            lobes->inverse_root[k][j] = (float)(power_entry(eigen, -0.5, k, j) / area);
        }
}

// dual: [PRT_OUTGOING][OUTGOING_DIRECTIONS], weights of the quadrature included.
static bool find_dual(struct prt_lobes *lobes, struct matrix_f64 *dual)
{
    struct host *host = lobes->host;
    struct matrix_f64 gram = { 0 }, basis = { 0 }, inverse = { 0 };
    struct linalg_eigen eigen = { 0 };
    bool ok = matrix_f64_init(host, &gram, PRT_OUTGOING, PRT_OUTGOING) &&
              matrix_f64_init(host, &inverse, PRT_OUTGOING, PRT_OUTGOING) &&
              matrix_f64_init(host, &basis, PRT_OUTGOING, OUTGOING_DIRECTIONS) &&
              matrix_f64_init(host, dual, PRT_OUTGOING, OUTGOING_DIRECTIONS);
    for (uint32_t i = 0; ok && i < OUTGOING_DIRECTIONS; i++) {
        float y[PRT_OUTGOING];
        sh_eval(PRT_OUTGOING_BANDS, outgoing_direction(i), y);
        add_products(y, &gram);
        for (size_t k = 0; k < PRT_OUTGOING; k++)
            basis.at[k * basis.stride + i] = (double)y[k] / OUTGOING_DIRECTIONS;
    }
    ok = ok && linalg_symmetric_eigen(host, "products of outgoing functions", &gram, &eigen);
    if (ok) fill_powers(&eigen, lobes, &inverse);
    ok = ok &&
         matrix_f64_multiply(host, 1, &inverse, NOT_TRANSPOSED, &basis, NOT_TRANSPOSED, 0, dual);
    linalg_eigen_finish(host, &eigen);
    matrix_f64_finish(host, &gram);
    matrix_f64_finish(host, &inverse);
    matrix_f64_finish(host, &basis);
    return ok;
}

// ---- lobes

// Weights of the rays in the mean over the lobe of an outgoing direction; they sum to 1.
static void weigh_rays(const struct prt_lobes *lobes, float roughness, vec3s outgoing,
                       double *weights)
{
    const struct bsdf_material mirror = { .albedo = { { 1, 1, 1 } },
                                          .metallic = 1.0f,
                                          .roughness = roughness };
    const struct bsdf bsdf = bsdf_of(UP, outgoing, &mirror, false);
    double sum = 0.0;
    for (size_t s = 0; s < lobes->rays; s++) {
        weights[s] = (double)(bsdf_reflect(&bsdf, lobes->direction[s]).f.x * lobes->direction[s].z);
        sum += weights[s];
    }
    for (size_t s = 0; s < lobes->rays; s++) weights[s] /= sum;
}

static bool fill_rows(struct prt_lobes *lobes, const struct matrix_f64 *dual, int lobe,
                      struct matrix_f64 *weights, struct matrix_f64 *rows)
{
    const float roughness = LEAST + RANGE * (float)lobe / (PRT_LOBES - 1);
    for (uint32_t i = 0; i < OUTGOING_DIRECTIONS; i++)
        weigh_rays(lobes, roughness, outgoing_direction(i), weights->at + i * weights->stride);
    if (!matrix_f64_multiply(lobes->host, 1, dual, NOT_TRANSPOSED, weights, NOT_TRANSPOSED, 0,
                             rows))
        return false;
    float *out = lobes->rows + (size_t)lobe * PRT_OUTGOING * lobes->rays;
    for (size_t i = 0; i < PRT_OUTGOING * lobes->rays; i++) out[i] = (float)rows->at[i];
    return true;
}

static bool find_rows(struct prt_lobes *lobes)
{
    struct matrix_f64 dual = { 0 }, weights = { 0 }, rows = { 0 };
    bool ok = find_dual(lobes, &dual) &&
              matrix_f64_init(lobes->host, &weights, OUTGOING_DIRECTIONS, lobes->rays) &&
              matrix_f64_init(lobes->host, &rows, PRT_OUTGOING, lobes->rays);
    for (int i = 0; ok && i < PRT_LOBES; i++) ok = fill_rows(lobes, &dual, i, &weights, &rows);
    matrix_f64_finish(lobes->host, &dual);
    matrix_f64_finish(lobes->host, &weights);
    matrix_f64_finish(lobes->host, &rows);
    return ok;
}

bool prt_lobes_init(struct prt_lobes *out, struct host *host, size_t rays)
{
    *out = (struct prt_lobes){ .host = host, .rays = rays };
    out->direction = host_alloc(host, rays, sizeof *out->direction);
    out->rows = host_alloc(host, rays, PRT_LOBES * PRT_OUTGOING * sizeof *out->rows);
    if (!out->direction || !out->rows) return false;
    for (size_t s = 0; s < rays; s++)
        out->direction[s] = sample_hemisphere_uniform(sobol_2d((uint32_t)s, 1));
    return find_rows(out);
}

void prt_lobes_finish(struct prt_lobes *lobes)
{
    if (!lobes->host) return;
    host_free(lobes->host, lobes->direction);
    host_free(lobes->host, lobes->rows);
    *lobes = (struct prt_lobes){ 0 };
}

void prt_lobes_at(const struct prt_lobes *lobes, float roughness, float *out)
{
    const size_t count = PRT_OUTGOING * lobes->rays;
    const float place = (PRT_LOBES - 1) * (roughness - LEAST) / RANGE;
    const float clamped = place > 0.0f ? place < PRT_LOBES - 1 ? place : PRT_LOBES - 1 : 0.0f;
    const size_t below = clamped < PRT_LOBES - 1 ? (size_t)clamped : PRT_LOBES - 2;
    const float above = clamped - (float)below, *low = lobes->rows + below * count;
    for (size_t i = 0; i < count; i++) out[i] = low[i] + above * (low[count + i] - low[i]);
}

void prt_lobes_transform(const float by[PRT_OUTGOING][PRT_OUTGOING], float *matrix, size_t width)
{
    for (size_t i = 0; i < width; i++) {
        float column[PRT_OUTGOING];
        for (size_t k = 0; k < PRT_OUTGOING; k++) column[k] = matrix[k * width + i];
        for (size_t k = 0; k < PRT_OUTGOING; k++) {
            double sum = 0.0;
            for (size_t j = 0; j < PRT_OUTGOING; j++) sum += (double)(by[k][j] * column[j]);
            matrix[k * width + i] = (float)sum;
        }
    }
}
