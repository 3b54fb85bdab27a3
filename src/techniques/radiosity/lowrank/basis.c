// Modes are the singular vectors of A L: L Lᵀ is the covariance of a prior over light, in which all
// nodes of the tree of sources have independent radiosities of the same variance. Large patches of
// light count as much as small ones; without it the sampling noise of single sources would be most
// of the norm. The singular vectors are found by the randomised range finder with power iterations
// (Halko, Martinsson & Tropp 2011, algorithm 4.4 and section 5.1).
#include "techniques/radiosity/lowrank/basis.h"

#include "core/rng.h"

#include <string.h>

// The components along the surface light shading normals that lean by about a quarter, and the
// specular lobe.
static const double WEIGHT[RADIOSITY_COMPONENTS] = { 1.0, 0.25, 0.25 };
enum { OVERSAMPLING = 8, POWER_ITERATIONS = 2 };

static double weight_of(size_t row)
{
    return WEIGHT[row % RADIOSITY_COMPONENTS];
}

// ---- the mean

// The first mode: row sums, and the mean distribution of irradiance over sources.
static void find_mean(const struct radiosity_operator *of, struct radiosity_basis *out)
{
    const struct matrix_f64 *a = of->rows;
    double *mean = out->v.at, total = 0.0;
    for (size_t r = 0; r < a->rows; r++) {
        double sum = 0.0;
        for (size_t i = 0; i < a->columns; i++) sum += a->at[r * a->stride + i];
        out->u.at[r * out->u.stride] = sum;
        if (r % RADIOSITY_COMPONENTS != 0) continue;
        for (size_t i = 0; i < a->columns; i++) mean[i] += a->at[r * a->stride + i];
        total += sum;
    }
    for (size_t i = 0; total > 0.0 && i < a->columns; i++) mean[i] /= total;
}

// The rest, with weights of rows: it gives uniform light nothing.
static void find_rest(const struct radiosity_operator *of, const struct radiosity_basis *mean,
                      struct matrix_f64 *out)
{
    const struct matrix_f64 *a = of->rows;
    for (size_t r = 0; r < a->rows; r++)
        for (size_t i = 0; i < a->columns; i++)
            out->at[r * out->stride + i] =
                weight_of(r) *
                (a->at[r * a->stride + i] - mean->u.at[r * mean->u.stride] * mean->v.at[i]);
}

// ---- the prior

// Numbers the nodes at which sources part, from 1, after the sources themselves; returns the number
// of both. Nodes with one child that has sources are not another patch of light.
static size_t number_nodes(const struct radiosity_operator *of, size_t sources)
{
    const struct radiosity_node *nodes = of->tree->nodes;
    for (size_t i = 0; i < sources; i++) of->number[of->nodes[i]] = (uint32_t)i + 1;
    uint32_t count = (uint32_t)sources;
    // Nodes are below their parents in number, but clusters: visit upwards.
    for (size_t i = 0; i < sources; i++)
        for (uint32_t n = nodes[of->nodes[i]].parent; n != RADIOSITY_NO_NODE; n = nodes[n].parent) {
            if (of->number[n] != 0) break;
            of->number[n] = UINT32_MAX;
        }
    for (size_t i = 0; i < sources; i++)
        for (uint32_t n = nodes[of->nodes[i]].parent; n != RADIOSITY_NO_NODE; n = nodes[n].parent) {
            const uint32_t *child = nodes[n].child;
            if (of->number[n] != UINT32_MAX) continue;
            if (of->number[child[0]] != 0 && of->number[child[1]] != 0) of->number[n] = ++count;
        }
    return count;
}

static void clear_nodes(const struct radiosity_operator *of, size_t sources)
{
    const struct radiosity_node *nodes = of->tree->nodes;
    for (size_t i = 0; i < sources; i++)
        for (uint32_t n = of->nodes[i]; n != RADIOSITY_NO_NODE && of->number[n] != 0;
             n = nodes[n].parent)
            of->number[n] = 0;
}

// out += m L
static void add_prior(const struct radiosity_operator *of, const struct matrix_f64 *m,
                      struct matrix_f64 *out)
{
    for (size_t i = 0; i < m->columns; i++)
        for (uint32_t n = of->nodes[i]; n != RADIOSITY_NO_NODE; n = of->tree->nodes[n].parent) {
            const uint32_t number = of->number[n];
            if (number == UINT32_MAX) continue;
            for (size_t r = 0; r < m->rows; r++)
                out->at[r * out->stride + number - 1] += m->at[r * m->stride + i];
        }
}

// ---- the range

static bool orthonormalise(struct host *host, struct matrix_f64 *y)
{
    struct linalg_svd svd = { 0 };
    const bool ok = linalg_svd(host, "the range of a region's transfer", y, &svd);
    for (size_t r = 0; ok && r < y->rows; r++)
        memcpy(y->at + r * y->stride, svd.u.at + r * svd.u.stride, y->columns * sizeof *y->at);
    linalg_svd_finish(host, &svd);
    return ok;
}

static void fill_random(struct matrix_f64 *m, uint64_t seed)
{
    for (size_t i = 0; i < m->rows * m->columns; i++)
        m->at[i] = (rng_mix(seed + i) & 1) != 0 ? 1.0 : -1.0;
}

// y: orthonormal columns that span most of the range of x.
static bool find_range(struct host *host, const struct matrix_f64 *x, struct matrix_f64 *y,
                       uint64_t seed)
{
    struct matrix_f64 z = { 0 };
    bool ok = matrix_f64_init(host, &z, x->columns, y->columns);
    if (ok) fill_random(&z, seed);
    for (int i = 0; ok && i <= POWER_ITERATIONS; i++) {
        if (i > 0) ok = matrix_f64_multiply(host, 1.0, x, TRANSPOSED, y, NOT_TRANSPOSED, 0.0, &z);
        ok = ok && matrix_f64_multiply(host, 1.0, x, NOT_TRANSPOSED, &z, NOT_TRANSPOSED, 0.0, y) &&
             orthonormalise(host, y);
    }
    matrix_f64_finish(host, &z);
    return ok;
}

static uint32_t rank_of(const struct linalg_svd *svd, double total, float energy, size_t most)
{
    double sum = 0.0;
    uint32_t rank = 0;
    while (rank < svd->count && rank < most && sum < (double)energy * total &&
           svd->sigma[rank] > 0.0) {
        sum += svd->sigma[rank] * svd->sigma[rank];
        rank++;
    }
    return rank;
}

// The left singular vectors of x that are kept.
static bool find_vectors(struct host *host, const struct matrix_f64 *x,
                         const struct radiosity_basis_how *how, struct matrix_f64 *out)
{
    size_t columns = how->most - 1 + OVERSAMPLING;
    columns = columns < x->rows ? columns : x->rows;
    columns = columns < x->columns ? columns : x->columns;
    struct matrix_f64 y = { 0 }, b = { 0 };
    struct linalg_svd svd = { 0 };
    bool ok = matrix_f64_init(host, &y, x->rows, columns) &&
              matrix_f64_init(host, &b, columns, x->columns) &&
              find_range(host, x, &y, how->seed) &&
              matrix_f64_multiply(host, 1.0, &y, TRANSPOSED, x, NOT_TRANSPOSED, 0.0, &b) &&
              linalg_svd(host, "a region's transfer", &b, &svd);
    if (ok) {
        const double norm = matrix_f64_norm(x);
        const uint32_t rank = rank_of(&svd, norm * norm, how->energy, how->most - 1);
        const struct matrix_f64 kept = matrix_f64_block(&svd.u, 0, 0, svd.u.rows, rank);
        ok = matrix_f64_init(host, out, x->rows, rank) &&
             (rank == 0 ||
              matrix_f64_multiply(host, 1.0, &y, NOT_TRANSPOSED, &kept, NOT_TRANSPOSED, 0.0, out));
    }
    linalg_svd_finish(host, &svd);
    matrix_f64_finish(host, &y);
    matrix_f64_finish(host, &b);
    return ok;
}

// ---- the modes

// u: of `rest`.
static bool set_modes(struct host *host, const struct matrix_f64 *rest, const struct matrix_f64 *u,
                      struct radiosity_basis *out)
{
    out->count = (uint32_t)u->columns + 1;
    if (u->columns == 0) return true;
    struct matrix_f64 v = matrix_f64_block(&out->v, 1, 0, u->columns, out->v.columns);
    for (size_t r = 0; r < u->rows; r++)
        for (size_t k = 0; k < u->columns; k++)
            out->u.at[r * out->u.stride + k + 1] = u->at[r * u->stride + k] / weight_of(r);
    return matrix_f64_multiply(host, 1.0, u, TRANSPOSED, rest, NOT_TRANSPOSED, 0.0, &v);
}

static bool add_modes(struct host *host, const struct radiosity_operator *of,
                      const struct radiosity_basis_how *how, struct radiosity_basis *out)
{
    const size_t rows = of->rows->rows, sources = of->rows->columns;
    struct matrix_f64 rest = { 0 }, x = { 0 }, u = { 0 };
    const size_t columns = number_nodes(of, sources);
    bool ok =
        matrix_f64_init(host, &rest, rows, sources) && matrix_f64_init(host, &x, rows, columns);
    if (ok) {
        find_rest(of, out, &rest);
        add_prior(of, &rest, &x);
    }
    clear_nodes(of, sources);
    ok = ok && find_vectors(host, &x, how, &u) && set_modes(host, &rest, &u, out);
    matrix_f64_finish(host, &rest);
    matrix_f64_finish(host, &x);
    matrix_f64_finish(host, &u);
    return ok;
}

bool radiosity_basis_init(struct radiosity_basis *out, struct host *host,
                          const struct radiosity_operator *of,
                          const struct radiosity_basis_how *how)
{
    *out = (struct radiosity_basis){ .count = 1 };
    bool ok = matrix_f64_init(host, &out->u, of->rows->rows, how->most) &&
              matrix_f64_init(host, &out->v, how->most, of->rows->columns);
    if (ok) find_mean(of, out);
    ok = ok && (how->most == 1 || of->rows->columns < 2 || add_modes(host, of, how, out));
    if (!ok) radiosity_basis_finish(out, host);
    return ok;
}

void radiosity_basis_finish(struct radiosity_basis *basis, struct host *host)
{
    matrix_f64_finish(host, &basis->u);
    matrix_f64_finish(host, &basis->v);
    *basis = (struct radiosity_basis){ 0 };
}
