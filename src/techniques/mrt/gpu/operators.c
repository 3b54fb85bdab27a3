// Packing and upload of operators.
//
// Half floats lose precision below 6·10⁻⁵. Each b-coefficient is therefore scaled by a power of
// two, so that its row of T_d→b and its column of U_b have about the same largest element; T_b→r
// undoes it. Powers of two change no bit of the result beyond that.
#include "techniques/mrt/gpu/upload.h"

#include "core/half.h"
#include "techniques/mrt/dictionary/rays.h"

#include <math.h>

// A buffer in the making.
struct words {
    struct host *host;
    uint32_t *at;
    size_t numbers; // written
    bool half;
};

static bool words_init(struct words *w, const struct mrt_runtime *runtime, size_t rows, int modes)
{
    *w = (struct words){ .host = runtime->host, .half = runtime->options.half };
    size_t numbers;
    if (!size_mul(rows, 4 * (size_t)mrt_quads(modes), &numbers))
        return host_fail(w->host, FAIL_MEMORY, "mrt: operators of %zu rows are too large", rows);
    w->at = host_alloc(w->host, numbers, w->half ? 2 : 4);
    return w->at;
}

static void pack(struct words *w, float value)
{
    if (w->half)
        ((uint16_t *)w->at)[w->numbers++] = half_from_float(value);
    else
        ((float *)w->at)[w->numbers++] = value;
}

// A row of `count` numbers, `stride` apart, padded with 0.
static void pack_row(struct words *w, const float *from, size_t stride, const float *factor,
                     int count)
{
    for (int m = 0; m < (int)(4 * mrt_quads(count)); m++)
        pack(w, m < count ? from[(size_t)m * stride] * (factor ? factor[m] : 1.0f) : 0.0f);
}

static bool words_upload(struct words *w, struct mrt_runtime *runtime, const char *name)
{
    bool ok = mrt_buffer_of(runtime, name, w->at, w->numbers * (w->half ? 2 : 4));
    host_free(w->host, w->at);
    return ok;
}

// ---- scales of b-coefficients

static float largest_in(const float *at, size_t count, size_t stride)
{
    float most = 0.0f;
    for (size_t i = 0; i < count; i++) most = fmaxf(most, fabsf(at[i * stride]));
    return most;
}

static float balance(const struct mrt_block_basis *basis, size_t mode)
{
    float t = largest_in(basis->t_db.at + mode * basis->t_db.stride, basis->t_db.columns, 1);
    float u = largest_in(basis->u[0].at + mode, basis->u[0].rows, basis->u[0].stride);
    if (!(t > 0.0f) || !(u > 0.0f)) return 1.0f;
    return exp2f(roundf(0.5f * (log2f(u) - log2f(t))));
}

static bool scales_init(struct mrt_scales *s, struct host *host, const struct mrt_operators *o)
{
    const size_t k_b = (size_t)o->k_b, count = (size_t)o->basis_count * k_b;
    *s = (struct mrt_scales){ .k_b = o->k_b };
    s->of_b = host_alloc(host, count, sizeof *s->of_b);
    s->inverse = host_alloc(host, count, sizeof *s->inverse);
    if (!s->of_b || !s->inverse) return false;
    for (size_t i = 0; i < count; i++) {
        s->of_b[i] = balance(&o->bases[i / k_b], i % k_b);
        s->inverse[i] = 1.0f / s->of_b[i];
    }
    return true;
}

static void scales_finish(struct mrt_scales *s, struct host *host)
{
    host_free(host, s->of_b);
    host_free(host, s->inverse);
}

// ---- operators

static size_t rows_of_bases(const struct mrt_operators *o, enum mrt_measure measure)
{
    size_t rows = 0;
    for (int i = 0; i < o->basis_count; i++) rows += o->bases[i].u[measure].rows;
    return rows;
}

static bool upload_t_db(struct mrt_runtime *runtime, const struct mrt_operators *o,
                        const struct mrt_scales *scales)
{
    struct words w;
    if (!words_init(&w, runtime, rows_of_bases(o, MRT_IRRADIANCE), o->k_b)) return false;
    for (int i = 0; i < o->basis_count; i++) {
        const struct matrix_f32 *t = &o->bases[i].t_db;
        for (size_t texel = 0; texel < t->columns; texel++)
            pack_row(&w, t->at + texel, t->stride, scales->of_b + i * scales->k_b, o->k_b);
    }
    return words_upload(&w, runtime, "mrt_t_db");
}

static void pack_matrix(struct words *w, const struct matrix_f32 *m, const float *factor, int count)
{
    for (size_t row = 0; row < m->rows; row++)
        pack_row(w, m->at + row * m->stride, 1, factor, count);
}

// U_b and U_r of a measure.
static bool upload_light(struct mrt_runtime *runtime, const struct mrt_operators *o,
                         const struct mrt_scales *scales, enum mrt_measure measure)
{
    static const char *const names_b[] = { "mrt_u_b", "mrt_u_b_vector", "mrt_u_b_probes" };
    static const char *const names_r[] = { "mrt_u_r", "mrt_u_r_vector", "mrt_u_r_probes" };
    struct words w;
    size_t rows = 0;
    if (!words_init(&w, runtime, rows_of_bases(o, measure), o->k_b)) return false;
    for (int i = 0; i < o->basis_count; i++)
        pack_matrix(&w, &o->bases[i].u[measure], scales->inverse + i * scales->k_b, o->k_b);
    if (!words_upload(&w, runtime, names_b[measure])) return false;
    for (int i = 0; i < o->response_count; i++) rows += o->responses[i].u[measure].rows;
    if (!words_init(&w, runtime, rows, o->k_r)) return false;
    for (int i = 0; i < o->response_count; i++)
        pack_matrix(&w, &o->responses[i].u[measure], NULL, o->k_r);
    return words_upload(&w, runtime, names_r[measure]);
}

static void pack_zeros(struct words *w, size_t count)
{
    for (size_t i = 0; i < count; i++) pack(w, 0.0f);
}

// By column, with k_b padded too.
static void pack_t_br(struct words *w, const struct matrix_f32 *of_b, const float *inverse)
{
    const size_t k_r = of_b->columns, quads = 4 * mrt_quads((int)k_r);
    for (size_t m = 0; m < of_b->rows; m++) {
        for (size_t k = 0; k < k_r; k++) pack(w, of_b->at[m * of_b->stride + k] * inverse[m]);
        pack_zeros(w, quads - k_r);
    }
    pack_zeros(w, (4 * mrt_quads((int)of_b->rows) - of_b->rows) * quads);
}

// [pair][k_b][k_r]
static bool upload_t_br(struct mrt_runtime *runtime, const struct mrt_operators *o,
                        const struct mrt_scales *scales)
{
    struct words w;
    if (!words_init(&w, runtime, mrt_pair_count(o) * 4 * mrt_quads(o->k_b), o->k_r)) return false;
    for (int i = 0; i < o->opening_count; i++)
        for (int k = 0; k < o->openings[i].pair_count; k++) {
            const struct mrt_pair *pair = &o->openings[i].pairs[k];
            pack_t_br(&w, &pair->of_b,
                      scales->inverse + o->basis_of_block[pair->source] * scales->k_b);
        }
    return words_upload(&w, runtime, "mrt_t_br");
}

// ---- clutter

// T_c→r and C_c, face after face of each opening.
static bool upload_coupling(struct mrt_runtime *runtime, const struct mrt_operators *o)
{
    struct words w;
    uint32_t count = 0;
    struct mrt_sender *senders = mrt_all_senders(runtime->host, o, &count);
    const bool ok = senders && words_init(&w, runtime, count, o->k_r);
    for (uint32_t i = 0; ok && i < count; i++) pack_row(&w, senders[i].of_c, 1, NULL, o->k_r);
    host_free(runtime->host, senders);
    return ok && words_upload(&w, runtime, "mrt_clutter_coupling");
}

// ---- the light map of clutter

static size_t rows_of_map(const struct mrt_clutter_rows *rows)
{
    return MRT_VECTOR_COEFFICIENTS * (size_t)MRT_LOCAL *
           mrt_clutter_map_tiles((size_t)rows->texel_count);
}

static void pack_padded(struct words *w, const struct matrix_f32 *m, size_t rows,
                        const float *factor, int count)
{
    pack_matrix(w, m, factor, count);
    pack_zeros(w, (rows - m->rows) * 4 * mrt_quads(count));
}

static bool upload_clutter_u_b(struct mrt_runtime *runtime, const struct mrt_operators *o,
                               const struct mrt_scales *scales)
{
    struct words w;
    size_t rows = 0;
    for (int i = 0; i < o->row_count; i++) rows += rows_of_map(&o->rows[i]);
    if (!words_init(&w, runtime, rows, o->k_b)) return false;
    for (int i = 0; i < o->row_count; i++)
        pack_padded(&w, &o->rows[i].u_b, rows_of_map(&o->rows[i]),
                    scales->inverse + o->basis_of_block[o->rows[i].block] * scales->k_b, o->k_b);
    return words_upload(&w, runtime, "mrt_clutter_u_b");
}

static size_t rows_of_opening(const struct mrt_operators *o, const struct mrt_opening *opening)
{
    const struct mrt_clutter_rows *rows = mrt_rows_of(o, opening->block);
    return rows ? rows_of_map(rows) : 0;
}

// T rows of a block and opening are those of its tiles.
static bool upload_clutter_u_r(struct mrt_runtime *runtime, const struct mrt_operators *o)
{
    struct words w;
    size_t rows = 0;
    for (int i = 0; i < o->opening_count; i++) rows += rows_of_opening(o, &o->openings[i]);
    if (!words_init(&w, runtime, rows, o->k_r)) return false;
    for (int i = 0; i < o->opening_count; i++)
        pack_padded(&w, &o->openings[i].at_clutter, rows_of_opening(o, &o->openings[i]), NULL,
                    o->k_r);
    return words_upload(&w, runtime, "mrt_clutter_u_r");
}

static bool upload_all(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                       const struct mrt_scales *scales)
{
    const struct mrt_operators *o = input->operators;
    return upload_t_db(runtime, o, scales) && upload_light(runtime, o, scales, MRT_IRRADIANCE) &&
           upload_t_br(runtime, o, scales) && mrt_reflection_upload(runtime, input, scales) &&
           (!runtime->options.vector || upload_light(runtime, o, scales, MRT_VECTOR)) &&
           (!runtime->options.probes || upload_light(runtime, o, scales, MRT_PROBE)) &&
           (o->clutter_count == 0 || upload_coupling(runtime, o)) &&
           (o->row_count == 0 ||
            (upload_clutter_u_b(runtime, o, scales) && upload_clutter_u_r(runtime, o)));
}

bool mrt_operators_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_scales scales = { 0 };
    const bool ok = scales_init(&scales, runtime->host, input->operators) &&
                    upload_all(runtime, input, &scales);
    scales_finish(&scales, runtime->host);
    return ok;
}
