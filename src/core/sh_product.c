// Products through the triple-product integrals ∫ Y_i Y_j Y_k dω (Sloan 2008, "Stupid Spherical
// Harmonics Tricks", "Product"). A quadrature that is exact for them computes the table of non-zero
// integrals once.
#include "core/sh_basis.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <stdint.h>

enum {
    // Exact for degree 15, the product of three functions of degree 5: eight Gauss–Legendre nodes
    // in z, sixteen equal steps in φ.
    NODES = 8,
    STEPS = 16,
    MAX_TERMS = SH_MAX_COUNT * (SH_MAX_COUNT + 1) * (SH_MAX_COUNT + 2) / 6, // all i ≤ j ≤ k
};

// One integral for all permutations of its indices: i ≤ j ≤ k.
struct term {
    uint8_t i, j, k;
    float integral;
};

struct product_table {
    struct term terms[MAX_TERMS];
    int count[SH_MAX_BANDS + 1]; // b bands use the first count[b] terms
};

static struct product_table table;
static pthread_once_t table_once = PTHREAD_ONCE_INIT;

// Node and weight by Newton's method on P_8 (Abramowitz & Stegun, 25.4.29; first guess 22.16.6).
static void gauss_legendre(int index, double *node, double *weight)
{
    static const double pi = 3.14159265358979323846;
    double z = cos(pi * (index + 0.75) / (NODES + 0.5)), slope = 1.0;
    for (int step = 0; step < 8; step++) {
        double previous = 1.0, value = z;
        for (int l = 1; l < NODES; l++) {
            double next = ((2 * l + 1) * z * value - l * previous) / (l + 1);
            previous = value;
            value = next;
        }
        slope = NODES * (z * value - previous) / (z * z - 1.0);
        z -= value / slope;
    }
    *node = z;
    *weight = 2.0 / ((1.0 - z * z) * slope * slope);
}

static void add_terms(double basis[NODES * STEPS][SH_MAX_COUNT], const double *weights, int k)
{
    for (int j = 0; j <= k; j++) {
        for (int i = 0; i <= j; i++) {
            double sum = 0.0;
            for (int p = 0; p < NODES * STEPS; p++)
                sum += weights[p] * basis[p][i] * basis[p][j] * basis[p][k];
            // Non-zero integrals are above 10⁻³; rounding leaves the others below 10⁻¹⁴.
            if (fabs(sum) < 1e-9) continue;
            int *count = &table.count[SH_MAX_BANDS];
            table.terms[(*count)++] =
                (struct term){ (uint8_t)i, (uint8_t)j, (uint8_t)k, (float)sum };
        }
    }
}

static void make_table(void)
{
    static const double pi = 3.14159265358979323846;
    double basis[NODES * STEPS][SH_MAX_COUNT], weights[NODES * STEPS];
    for (int a = 0; a < NODES; a++) {
        double z, weight;
        gauss_legendre(a, &z, &weight);
        for (int b = 0; b < STEPS; b++) {
            double phi = 2.0 * pi * (b + 0.5) / STEPS, r = sqrt(1.0 - z * z);
            sh_eval_double(SH_MAX_BANDS, (double[3]){ r * cos(phi), r * sin(phi), z },
                           basis[a * STEPS + b]);
            weights[a * STEPS + b] = weight * 2.0 * pi / STEPS;
        }
    }
    for (int band = 0; band < SH_MAX_BANDS; band++) {
        for (int k = SH_COUNT(band); k < SH_COUNT(band + 1); k++) add_terms(basis, weights, k);
        table.count[band + 1] = table.count[SH_MAX_BANDS];
    }
}

void sh_product(int bands, const float *a, const float *b, float *out)
{
    assert(bands >= 1 && bands <= SH_MAX_BANDS);
    pthread_once(&table_once, make_table);
    double sum[SH_MAX_COUNT] = { 0.0 };
    for (int t = 0; t < table.count[bands]; t++) {
        const struct term *term = &table.terms[t];
        int i = term->i, j = term->j, k = term->k;
        double g = (double)term->integral, ai = (double)a[i], aj = (double)a[j], ak = (double)a[k];
        double bi = (double)b[i], bj = (double)b[j], bk = (double)b[k];
        // Each distinct permutation once.
        if (i == j && j == k) {
            sum[k] += g * ai * bi;
        } else if (i == j) {
            sum[k] += g * ai * bi;
            sum[i] += g * (ai * bk + ak * bi);
        } else if (j == k) {
            sum[i] += g * aj * bj;
            sum[j] += g * (ai * bj + aj * bi);
        } else {
            sum[i] += g * (aj * bk + ak * bj);
            sum[j] += g * (ai * bk + ak * bi);
            sum[k] += g * (ai * bj + aj * bi);
        }
    }
    for (int i = 0; i < SH_COUNT(bands); i++) out[i] = (float)sum[i];
}
