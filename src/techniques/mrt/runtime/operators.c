// Packing and upload of operators.
//
// Half floats lose precision below 6·10⁻⁵. Each b-coefficient is therefore scaled by a power of
// two, so that its row of T_d→b and its column of U_b have about the same largest element; T_b→r
// undoes it. Powers of two change no bit of the result beyond that.
#include "operators.h"

#include "core/half.h"
#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/runtime/objects.h"
#include "techniques/mrt/runtime/reflection.h"
#include "techniques/mrt/runtime/tables.h"

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

static bool words_upload(struct words *w, struct mrt_runtime *runtime, const char *name,
                         gpu_buffer *out)
{
    bool ok = mrt_buffer_of(runtime, name, w->at, w->numbers * (w->half ? 2 : 4), out);
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

static float balance(const struct mrt_basis_input *basis, size_t mode)
{
    float t = largest_in(basis->t_db.at + mode * basis->t_db.stride, basis->t_db.columns, 1);
    float u = largest_in(basis->u[0].at + mode, basis->u[0].rows, basis->u[0].stride);
    if (!(t > 0.0f) || !(u > 0.0f)) return 1.0f;
    return exp2f(roundf(0.5f * (log2f(u) - log2f(t))));
}

static bool scales_init(struct mrt_scales *s, struct host *host,
                        const struct mrt_runtime_input *input)
{
    size_t count = (size_t)input->basis_count * (size_t)input->k_b;
    *s = (struct mrt_scales){ .k_b = input->k_b };
    s->of_b = host_alloc(host, count, sizeof *s->of_b);
    s->inverse = host_alloc(host, count, sizeof *s->inverse);
    if (!s->of_b || !s->inverse) return false;
    for (size_t i = 0; i < count; i++) {
        s->of_b[i] = balance(&input->bases[i / (size_t)input->k_b], i % (size_t)input->k_b);
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

static size_t rows_of_bases(const struct mrt_runtime_input *input)
{
    size_t rows = 0;
    for (int i = 0; i < input->basis_count; i++) rows += input->bases[i].u[0].rows;
    return rows;
}

static bool upload_t_db(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                        const struct mrt_scales *scales)
{
    struct words w;
    if (!words_init(&w, runtime, rows_of_bases(input), input->k_b)) return false;
    for (int i = 0; i < input->basis_count; i++) {
        const struct matrix_f32 *t = &input->bases[i].t_db;
        for (size_t texel = 0; texel < t->columns; texel++)
            pack_row(&w, t->at + texel, t->stride, scales->of_b + i * scales->k_b, input->k_b);
    }
    return words_upload(&w, runtime, "t_db", &runtime->buffers.t_db);
}

static void pack_matrix(struct words *w, const struct matrix_f32 *m, const float *factor, int count)
{
    for (size_t row = 0; row < m->rows; row++)
        pack_row(w, m->at + row * m->stride, 1, factor, count);
}

static bool upload_u_b(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                       const struct mrt_scales *scales, enum mrt_measure measure, gpu_buffer *out)
{
    static const char *const names[] = { "u_b", "u_b_vector", "u_b_probes" };
    struct words w;
    size_t rows = 0;
    for (int i = 0; i < input->basis_count; i++) rows += input->bases[i].u[measure].rows;
    if (!words_init(&w, runtime, rows, input->k_b)) return false;
    for (int i = 0; i < input->basis_count; i++)
        pack_matrix(&w, &input->bases[i].u[measure], scales->inverse + i * scales->k_b, input->k_b);
    return words_upload(&w, runtime, names[measure], out);
}

static bool upload_u_r(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                       enum mrt_measure measure, gpu_buffer *out)
{
    static const char *const names[] = { "u_r", "u_r_vector", "u_r_probes" };
    struct words w;
    size_t rows = 0;
    for (int i = 0; i < input->response_count; i++) rows += input->responses[i].u[measure].rows;
    if (!words_init(&w, runtime, rows, input->k_r)) return false;
    for (int i = 0; i < input->response_count; i++)
        pack_matrix(&w, &input->responses[i].u[measure], NULL, input->k_r);
    return words_upload(&w, runtime, names[measure], out);
}

// By column: [pair][k_b][k_r], with k_b padded too.
static bool upload_t_br(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                        const struct mrt_scales *scales)
{
    struct words w;
    const int columns = (int)(4 * mrt_quads(input->k_b));
    const float zero = 0.0f;
    if (!words_init(&w, runtime, (size_t)input->pair_count * (size_t)columns, input->k_r))
        return false;
    for (int i = 0; i < input->pair_count; i++) {
        const struct mrt_pair_input *pair = &input->pairs[i];
        const float *inverse = scales->inverse + input->basis_of_block[pair->source] * scales->k_b;
        for (int m = 0; m < columns; m++) {
            const bool kept = m < input->k_b;
            for (int k = 0; k < (int)(4 * mrt_quads(input->k_r)); k++)
                pack(&w, kept && k < input->k_r
                             ? pair->t_br[m * input->t_br_stride + k] * inverse[m]
                             : zero);
        }
    }
    return words_upload(&w, runtime, "t_br", &runtime->buffers.t_br);
}

// ---- clutter

// T_c→r and C_c, face after face of each opening.
static bool upload_coupling(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct words w;
    uint32_t count = 0;
    for (int i = 0; i < input->opening_count; i++) count += mrt_senders(input, i, NULL);
    struct mrt_sender *senders = host_alloc(runtime->host, count, sizeof *senders);
    bool ok = senders && words_init(&w, runtime, count, input->k_r);
    for (int i = 0; ok && i < input->opening_count; i++) {
        const uint32_t of_opening = mrt_senders(input, i, senders);
        for (uint32_t k = 0; k < of_opening; k++)
            pack_row(&w, senders[k].of_c, 1, NULL, input->k_r);
    }
    host_free(runtime->host, senders);
    return ok && words_upload(&w, runtime, "clutter_coupling", &runtime->clutter.coupling);
}

// ---- the light map of clutter

static size_t rows_of_map(const struct mrt_clutter_rows_input *rows)
{
    return MRT_VECTOR_COEFFICIENTS * (size_t)MRT_LOCAL *
           mrt_clutter_map_tiles((size_t)rows->texel_count);
}

static void pack_padded(struct words *w, const struct matrix_f32 *m, size_t rows,
                        const float *factor, int count)
{
    const float zero = 0.0f;
    pack_matrix(w, m, factor, count);
    for (size_t i = m->rows * 4 * mrt_quads(count); i < rows * 4 * mrt_quads(count); i++)
        pack(w, zero);
}

// T rows of a block and opening are those of its tiles.
static bool upload_clutter_map(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                               const struct mrt_scales *scales)
{
    const struct mrt_clutter_atlas_input *atlas = &input->clutter->atlas;
    struct mrt_runtime_clutter_map *to = &runtime->clutter.map;
    struct words b, r;
    size_t rows_b = 0, rows_r = 0;
    for (int i = 0; i < atlas->count; i++) {
        rows_b += rows_of_map(&atlas->rows[i]);
        for (int k = 0; k <= CUBE_FACES && atlas->rows[i].u_r[k].rows > 0; k++)
            rows_r += rows_of_map(&atlas->rows[i]);
    }
    if (!words_init(&b, runtime, rows_b, input->k_b)) return false;
    if (!words_init(&r, runtime, rows_r, input->k_r)) {
        host_free(b.host, b.at);
        return false;
    }
    for (int i = 0; i < atlas->count; i++) {
        const struct mrt_clutter_rows_input *rows = &atlas->rows[i];
        const size_t count = rows_of_map(rows);
        pack_padded(&b, &rows->u_b, count,
                    scales->inverse + input->basis_of_block[rows->block] * scales->k_b, input->k_b);
        for (int k = 0; k <= CUBE_FACES && rows->u_r[k].rows > 0; k++)
            pack_padded(&r, &rows->u_r[k], count, NULL, input->k_r);
    }
    const bool ok = words_upload(&b, runtime, "clutter_u_b", &to->u_b);
    return words_upload(&r, runtime, "clutter_u_r", &to->u_r) && ok;
}

bool mrt_operators_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input)
{
    struct mrt_scales scales = { 0 };
    struct mrt_runtime_buffers *b = &runtime->buffers;
    bool ok = scales_init(&scales, runtime->host, input) && upload_t_db(runtime, input, &scales) &&
              upload_u_b(runtime, input, &scales, MRT_IRRADIANCE, &b->u_b) &&
              upload_u_r(runtime, input, MRT_IRRADIANCE, &b->u_r) &&
              upload_t_br(runtime, input, &scales);
    ok = ok && mrt_reflection_upload(runtime, input, &scales);
    if (ok && runtime->options.vector)
        ok = upload_u_b(runtime, input, &scales, MRT_VECTOR, &b->u_b_vector) &&
             upload_u_r(runtime, input, MRT_VECTOR, &b->u_r_vector);
    if (ok && runtime->options.probes)
        ok = upload_u_b(runtime, input, &scales, MRT_PROBE, &runtime->probes.u_b) &&
             upload_u_r(runtime, input, MRT_PROBE, &runtime->probes.u_r);
    if (ok && input->clutter) ok = upload_coupling(runtime, input);
    if (ok && input->clutter && input->clutter->atlas.count > 0)
        ok = upload_clutter_map(runtime, input, &scales);
    scales_finish(&scales, runtime->host);
    return ok;
}
