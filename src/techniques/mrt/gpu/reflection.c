// The operator of one bounce within the reduced spaces, for bounce.comp. Floats: a few kilobytes
// per block, which all bounces share.
#include "techniques/mrt/gpu/upload.h"

struct builder {
    struct host *host;
    const struct mrt_runtime_input *input;
    const struct mrt_scales *scales;
    size_t face; // texels of a wall
    float *out;  // next column
};

// Light of b and of each opening at the texels of a block, reflected by them.
static void fill_reflected(const struct builder *s, int block, int first_opening, int colour,
                           struct matrix_f32 *out)
{
    const struct mrt_runtime_input *input = s->input;
    const struct mrt_operators *o = input->operators;
    const struct mrt_block_basis *basis = &o->bases[o->basis_of_block[block]];
    const int first = mrt_first_texel(input->atlas, block);
    const struct mrt_block *of = &input->map->blocks[block];
    size_t row = 0;
    for (int f = 0; f < CUBE_FACES; f++) {
        if (!mrt_block_has_wall(of, f)) continue;
        for (size_t t = 0; t < s->face; t++, row++) {
            const struct mrt_geometry_texel *texel = &input->images->geometry[first + (int)row];
            const float reflectance = mrt_shown_reflectance(texel).raw[colour];
            float *to = out->at + row * out->stride;
            const float *u_b = basis->u[0].at + row * basis->u[0].stride;
            for (int k = 0; k < o->k_b; k++) *to++ = reflectance * u_b[k];
            for (int i = first_opening; to < out->at + row * out->stride + out->columns; i++) {
                const struct matrix_f32 *u_r = o->responses[o->openings[i].response].u;
                const float *from = u_r->at + ((size_t)f * s->face + t) * u_r->stride;
                for (int k = 0; k < o->k_r; k++) *to++ = reflectance * from[k];
            }
        }
    }
}

// Columns of k_b and of k_r are padded to quads, and so are rows.
static void place_columns(const struct builder *s, int block, int colour,
                          const struct matrix_f32 *product)
{
    const struct mrt_operators *o = s->input->operators;
    const size_t quads_b = 4 * mrt_quads(o->k_b), quads_r = 4 * mrt_quads(o->k_r);
    const size_t k_b = (size_t)o->k_b, k_r = (size_t)o->k_r;
    const size_t scale = (size_t)o->basis_of_block[block] * k_b;
    for (size_t m = 0; m < product->columns; m++) {
        const bool own = m < k_b;
        const size_t entered = own ? 0 : m - k_b;
        const size_t column = own ? m : quads_b + entered / k_r * quads_r + entered % k_r;
        const float factor = own ? s->scales->inverse[scale + m] : 1.0f;
        float *to = s->out + (3 * column + (size_t)colour) * quads_b;
        for (size_t k = 0; k < k_b; k++)
            to[k] = factor * s->scales->of_b[scale + k] * product->at[k * product->stride + m];
    }
}

static bool add_block(struct builder *s, int block, int first_opening, int openings)
{
    const struct mrt_operators *o = s->input->operators;
    const struct matrix_f32 *t_db = &o->bases[o->basis_of_block[block]].t_db;
    const size_t columns = (size_t)(o->k_b + openings * o->k_r);
    struct matrix_f32 light = { 0 }, product = { 0 };
    bool ok = t_db->columns == 0 || (matrix_f32_init(s->host, &light, t_db->columns, columns) &&
                                     matrix_f32_init(s->host, &product, t_db->rows, columns));
    for (int c = 0; ok && c < 3 && t_db->columns > 0; c++) {
        fill_reflected(s, block, first_opening, c, &light);
        ok = matrix_f32_multiply(s->host, 1.0f, t_db, NOT_TRANSPOSED, &light, NOT_TRANSPOSED, 0.0f,
                                 &product);
        if (ok) place_columns(s, block, c, &product);
    }
    matrix_f32_finish(s->host, &light);
    matrix_f32_finish(s->host, &product);
    s->out += 3 * 4 * mrt_quads(o->k_b) *
              (4 * mrt_quads(o->k_b) + (size_t)openings * 4 * mrt_quads(o->k_r));
    return ok;
}

// ---- the remainder of the series of bounces

// Light of many bounces falls by about the mean reflectance of the walls from one to the next.
static float remainder_of(const struct mrt_runtime_input *input)
{
    static const float MOST = 0.95f;
    vec3s sum = vec3_of(0, 0, 0);
    float area_m2 = 0.0f;
    for (int t = 0; t < input->atlas->texels; t++) {
        const struct mrt_geometry_texel *texel = &input->images->geometry[t];
        sum = glms_vec3_muladds(mrt_shown_reflectance(texel), texel->area_m2, sum);
        area_m2 += texel->area_m2;
    }
    const float mean = area_m2 > 0.0f ? glms_vec3_max(sum) / area_m2 : 0.0f;
    return 1.0f / (1.0f - fminf(mean, MOST));
}

bool mrt_reflection_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                           const struct mrt_scales *scales)
{
    const struct mrt_operators *o = input->operators;
    const size_t rows = 4 * mrt_quads(o->k_b);
    const size_t columns =
        (size_t)input->map->count * rows + (size_t)o->opening_count * 4 * mrt_quads(o->k_r);
    float *all = host_alloc(runtime->host, columns, 3 * rows * sizeof *all);
    struct builder s = { runtime->host, input, scales, runtime->level.texels_of_tile, all };
    bool ok = all;
    runtime->rest = remainder_of(input);
    for (int b = 0, opening = 0; ok && b < input->map->count; b++) {
        const int first = opening;
        while (opening < o->opening_count && o->openings[opening].block == b) opening++;
        ok = add_block(&s, b, first, opening - first);
    }
    ok = ok && mrt_buffer_of(runtime, "mrt_reflection", all, columns * 3 * rows * sizeof *all);
    host_free(runtime->host, all);
    return ok;
}
