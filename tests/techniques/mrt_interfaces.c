// Builds the interface operators of a block dictionary in memory.
#include "techniques/mrt_interfaces.h"

#include "framework/test.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/basis.h"

#include <math.h>
#include <string.h>

static int turns_of(const struct mrt_interfaces *x)
{
    return x->options.maze == MRT_MAZE_2D ? MRT_TURNS_2D : MRT_TURNS_3D;
}

size_t mrt_interfaces_column(const struct mrt_interfaces *x, int cube, int face)
{
    size_t opening = 0;
    for (int c = 0; c <= cube; c++)
        for (int f = 0; f < CUBE_FACES; f++) {
            if (c == cube && f == face) return opening * (size_t)x->options.k_b;
            opening += mrt_cube_missing(x->options.maze, c) >> f & 1u;
        }
    return 0;
}

// Row ranges of the lightfield matrices, one per position.
struct rows_job {
    struct mrt_interfaces *x;
    enum mrt_turn turn;
    const struct mrt_span *span;
    const struct matrix_f32 *from, *coefficients;
    struct matrix_f32 *out;
};

static size_t rows_per_task(const struct mrt_interfaces *x)
{
    return (size_t)(x->options.lightfield.directions * x->options.lightfield.directions);
}

static size_t row_tasks(const struct mrt_interfaces *x)
{
    return mrt_lightfield_samples(x->options.lightfield) / rows_per_task(x);
}

static struct matrix_f32 rows_of(const struct rows_job *job, size_t task, size_t *first)
{
    *first = task * rows_per_task(job->x);
    return matrix_f32_block(job->out, *first, 0, rows_per_task(job->x), job->out->columns);
}

static void surfaces_task(void *user, size_t task)
{
    struct rows_job *job = user;
    size_t first;
    struct matrix_f32 rows = rows_of(job, task, &first);
    CHECK(mrt_lightfield_of_surfaces(test_host(), job->x->options.lightfield, job->from,
                                     job->x->options.resolution, first, &rows));
}

static void propagate_task(void *user, size_t task)
{
    struct rows_job *job = user;
    size_t first;
    struct matrix_f32 rows = rows_of(job, task, &first);
    CHECK(
        mrt_propagate(test_host(), job->x->options.lightfield, job->turn, job->from, first, &rows));
}

static void apply_task(void *user, size_t task)
{
    struct rows_job *job = user;
    size_t first;
    struct matrix_f32 rows = rows_of(job, task, &first);
    CHECK(mrt_span_apply(test_host(), job->span, first, job->coefficients, &rows));
}

enum { GRAM_TASKS = 16 };

struct gram_job {
    const struct mrt_span *span;
    struct matrix_f64 part[GRAM_TASKS];
};

static void gram_task(void *user, size_t task)
{
    struct gram_job *job = user;
    size_t all = job->span->part[0].rows, first = all * task / GRAM_TASKS;
    size_t end = all * (task + 1) / GRAM_TASKS;
    CHECK(mrt_span_gram(test_host(), job->span, first, end - first, &job->part[task]));
}

static struct matrix_f64 gram_of(const struct mrt_span *span)
{
    struct gram_job job = { .span = span };
    size_t n = mrt_span_columns(span);
    for (int i = 0; i < GRAM_TASKS; i++) CHECK(matrix_f64_init(test_host(), &job.part[i], n, n));
    parallel_for(GRAM_TASKS, 1, gram_task, &job);
    for (int i = 1; i < GRAM_TASKS; i++) {
        for (size_t k = 0; k < n * n; k++) job.part[0].at[k] += job.part[i].at[k];
        matrix_f64_finish(test_host(), &job.part[i]);
    }
    return job.part[0];
}

// h_rlf = U Σ of the span.
static void reduce(struct mrt_interfaces *x, const struct mrt_span *span,
                   const struct matrix_f64 *gram, const double *factor)
{
    struct matrix_f32 coefficients, basis;
    size_t modes = (size_t)x->options.k_rlf;
    CHECK(matrix_f32_init(test_host(), &coefficients, mrt_span_columns(span), modes));
    CHECK(matrix_f32_init(test_host(), &basis, span->part[0].rows, modes));
    CHECK(mrt_span_reduce(test_host(), gram, factor, &coefficients, x->sigma));
    struct rows_job job = { .x = x, .span = span, .coefficients = &coefficients, .out = &basis };
    parallel_for(row_tasks(x), 1, apply_task, &job);
    matrix_f32_finish(test_host(), &coefficients);
    matrix_f32_finish(test_host(), &x->h_rlf);
    x->h_rlf = basis;
}

static void build_transfer(struct mrt_interfaces *x)
{
    double sums[MRT_MAX_CUBES], all = 0.0;
    int cubes = mrt_cube_count(x->options.maze);
    struct mrt_shape left = mrt_cube_left(x->options.resolution);
    size_t k_b = (size_t)x->options.k_b;
    size_t columns = (size_t)mrt_cube_openings(x->options.maze) * k_b;
    CHECK(matrix_f32_init(test_host(), &x->implicit, (size_t)mrt_shape_texels(&left), columns));
    x->scale = host_alloc(test_host(), columns, sizeof *x->scale);
    for (int c = 0; c < cubes; c++) {
        struct mrt_shape cube =
            mrt_cube(x->options.resolution, mrt_cube_missing(x->options.maze, c));
        struct mrt_transfer *t = &x->transfer[c];
        mrt_fixture_transfer(&cube, x->options.k_b, true, &x->f[c], t);
        sums[c] = 0.0;
        for (size_t i = 0; i < t->sigma_m_count; i++) sums[c] += t->sigma_m[i] * t->sigma_m[i];
        all += sums[c];
        struct matrix_f32 l_imp;
        CHECK(matrix_f32_from_f64(test_host(), &t->l_imp, &l_imp));
        for (int f = 0; f < CUBE_FACES; f++) {
            if (!(cube.missing >> f & 1u)) continue;
            size_t first = mrt_interfaces_column(x, c, f);
            struct matrix_f32 to = matrix_f32_block(&x->implicit, 0, first, x->implicit.rows, k_b);
            mrt_seen_from_opening(&cube, f, &l_imp, &to);
            for (size_t k = 0; k < k_b; k++) x->scale[first + k] = sums[c];
        }
        matrix_f32_finish(test_host(), &l_imp);
    }
    for (size_t k = 0; k < columns; k++)
        x->scale[k] = x->scale[k] > 0.0 ? sqrt(all / (x->scale[k] * (double)cubes)) : 1.0;
}

static void build_basis(struct mrt_interfaces *x)
{
    struct mrt_span span = { .parts = 1 };
    CHECK(matrix_f32_init(test_host(), &x->h_lf, mrt_lightfield_samples(x->options.lightfield),
                          x->implicit.columns));
    x->sigma = host_alloc(test_host(), (size_t)x->options.k_rlf, sizeof *x->sigma);
    struct rows_job job = { .x = x, .from = &x->implicit, .out = &x->h_lf };
    parallel_for(row_tasks(x), 1, surfaces_task, &job);
    span.part[0] = x->h_lf;
    struct matrix_f64 gram = gram_of(&span);
    reduce(x, &span, &gram, x->scale);
    matrix_f64_finish(test_host(), &gram);
}

// The basis after each turn, beside each other: samples × (turns · k_rlf).
static struct matrix_f32 propagated(struct mrt_interfaces *x)
{
    struct matrix_f32 all;
    size_t modes = (size_t)x->options.k_rlf;
    CHECK(matrix_f32_init(test_host(), &all, x->h_rlf.rows, modes * (size_t)turns_of(x)));
    for (int t = 0; t < turns_of(x); t++) {
        struct matrix_f32 out = matrix_f32_block(&all, 0, (size_t)t * modes, all.rows, modes);
        struct rows_job job = { .x = x, .turn = (enum mrt_turn)t, .from = &x->h_rlf, .out = &out };
        parallel_for(row_tasks(x), 1, propagate_task, &job);
    }
    return all;
}

static void enrich_basis(struct mrt_interfaces *x)
{
    struct matrix_f32 further = propagated(x);
    struct mrt_span span = { { x->h_rlf, further }, 2 };
    struct matrix_f64 gram = gram_of(&span);
    double *factor = host_alloc(test_host(), gram.rows, sizeof *factor);
    mrt_span_balance(&gram, x->h_rlf.columns, factor);
    reduce(x, &span, &gram, factor);
    host_free(test_host(), factor);
    matrix_f64_finish(test_host(), &gram);
    matrix_f32_finish(test_host(), &further);
}

static void project(struct mrt_interfaces *x, const struct matrix_f32 *lightfields,
                    struct matrix_f32 *out)
{
    CHECK(matrix_f32_init(test_host(), out, x->h_rlf.columns, lightfields->columns));
    CHECK(mrt_project_add(test_host(), &x->h_rlf, lightfields, 0, x->h_rlf.rows, out));
    mrt_project_finish(x->sigma, out);
}

static void build_operators(struct mrt_interfaces *x)
{
    project(x, &x->h_lf, &x->r_b);
    struct matrix_f32 further = propagated(x);
    size_t modes = x->h_rlf.columns;
    for (int t = 0; t < turns_of(x); t++) {
        struct matrix_f32 one =
            matrix_f32_block(&further, 0, (size_t)t * modes, further.rows, modes);
        project(x, &one, &x->r_turn[t]);
    }
    matrix_f32_finish(test_host(), &further);
}

struct response_job {
    struct mrt_interfaces *x;
    struct mrt_shape entered;
    struct mrt_rays rays;
    struct matrix_f32 g;
};

enum { RESPONSE_BATCH = 16 };

static void response_task(void *user, size_t task)
{
    struct response_job *job = user;
    struct matrix_f32 rows;
    size_t first = task * RESPONSE_BATCH, count = job->g.rows - first;
    if (count > RESPONSE_BATCH) count = RESPONSE_BATCH;
    CHECK(matrix_f32_init(test_host(), &rows, count, job->x->h_rlf.rows));
    for (size_t r = 0; r < count; r++)
        mrt_gather_interface(job->x->options.lightfield,
                             mrt_shape_texel(&job->entered, (int)(first + r)), &job->rays,
                             rows.at + r * rows.stride);
    struct matrix_f32 out = matrix_f32_block(&job->g, first, 0, count, job->g.columns);
    CHECK(matrix_f32_multiply(test_host(), 1.0f, &rows, AS_IT_IS, &job->x->h_rlf, AS_IT_IS, 0.0f,
                              &out));
    matrix_f32_finish(test_host(), &rows);
}

static void build_response(struct mrt_interfaces *x)
{
    struct response_job job = { .x = x, .entered = mrt_cube_entered(x->options.resolution) };
    size_t texels = (size_t)mrt_shape_texels(&job.entered);
    CHECK(mrt_rays_init(test_host(), MRT_IRRADIANCE, 16384, &job.rays));
    CHECK(matrix_f32_init(test_host(), &job.g, texels, x->h_rlf.columns));
    parallel_for((texels + RESPONSE_BATCH - 1) / RESPONSE_BATCH, 1, response_task, &job);
    CHECK(mrt_response_init(test_host(), &job.g, x->options.k_r, &x->response));
    matrix_f32_finish(test_host(), &job.g);
    mrt_rays_finish(test_host(), &job.rays);
}

void mrt_interfaces_build(const struct mrt_interface_options *options, struct mrt_interfaces *out)
{
    memset(out, 0, sizeof *out);
    out->options = *options;
    build_transfer(out);
    build_basis(out);
    for (int i = 0; i < options->rounds; i++) enrich_basis(out);
    build_operators(out);
    build_response(out);
}

void mrt_interfaces_finish(struct mrt_interfaces *x)
{
    struct host *host = test_host();
    for (int i = 0; i < MRT_MAX_CUBES; i++) {
        matrix_f64_finish(host, &x->f[i]);
        mrt_transfer_finish(host, &x->transfer[i]);
    }
    for (int i = 0; i < MRT_TURNS_3D; i++) matrix_f32_finish(host, &x->r_turn[i]);
    matrix_f32_finish(host, &x->implicit);
    matrix_f32_finish(host, &x->h_lf);
    matrix_f32_finish(host, &x->h_rlf);
    matrix_f32_finish(host, &x->r_b);
    mrt_response_finish(host, &x->response);
    host_free(host, x->scale);
    host_free(host, x->sigma);
}
