// Texels and tangent frames of the dictionary's cubes, rotated to the blocks of a level.
#include "level_operators.h"

#include "techniques/mrt/runtime/rotated_probes.h"

#include <string.h>

// Texels of `from`, rotated by to_from, as those of `to`.
struct turn {
    struct mrt_shape from, to;
    mat3s to_from;
};

static bool empty_matrix(struct host *host, const struct turn *turn, int values, size_t columns,
                         struct matrix_f32 *out)
{
    return matrix_f32_init(host, out, (size_t)(mrt_shape_texels(&turn->to) * values), columns);
}

// One row per texel. Openings of `from` stay 0.
static bool turn_rows(struct host *host, const struct turn *turn, const struct matrix_f32 *from,
                      struct matrix_f32 *out)
{
    if (!empty_matrix(host, turn, 1, from->columns, out)) return false;
    for (int t = 0; t < mrt_shape_texels(&turn->to); t++) {
        int texel = mrt_rotated_texel(&turn->from, turn->to_from, &turn->to, t);
        if (texel < 0) continue;
        memcpy(out->at + (size_t)t * out->stride, from->at + (size_t)texel * from->stride,
               from->columns * sizeof *out->at);
    }
    return true;
}

static bool turn_columns(struct host *host, const struct turn *turn, const struct matrix_f32 *from,
                         struct matrix_f32 *out)
{
    size_t texels = (size_t)mrt_shape_texels(&turn->to);
    if (!matrix_f32_init(host, out, from->rows, texels)) return false;
    for (size_t t = 0; t < texels; t++) {
        int texel = mrt_rotated_texel(&turn->from, turn->to_from, &turn->to, (int)t);
        for (size_t m = 0; m < from->rows; m++)
            out->at[m * out->stride + t] = from->at[m * from->stride + (size_t)texel];
    }
    return true;
}

// Linear SH coefficients y, z, x turn like a vector, from the tangent frame of one texel to that of
// the other.
static void turn_vector(mat3s to_from, const float *from, size_t from_stride, float *to,
                        size_t to_stride, size_t columns)
{
    for (size_t c = 0; c < columns; c++) {
        vec3s v =
            vec3_of(from[3 * from_stride + c], from[from_stride + c], from[2 * from_stride + c]);
        v = glms_mat3_mulv(to_from, v);
        to[c] = from[c];
        to[to_stride + c] = v.y;
        to[2 * to_stride + c] = v.z;
        to[3 * to_stride + c] = v.x;
    }
}

// Four rows per texel.
static bool turn_vectors(struct host *host, const struct turn *turn, const struct matrix_f32 *from,
                         struct matrix_f32 *out)
{
    if (!empty_matrix(host, turn, MRT_VECTOR_COEFFICIENTS, from->columns, out)) return false;
    for (int t = 0; t < mrt_shape_texels(&turn->to); t++) {
        int texel = mrt_rotated_texel(&turn->from, turn->to_from, &turn->to, t);
        if (texel < 0) continue;
        mat3s from_frame = mrt_shape_texel(&turn->from, texel).frame;
        mat3s to_frame = mrt_shape_texel(&turn->to, t).frame;
        mat3s tangent =
            glms_mat3_mul(glms_mat3_transpose(to_frame), glms_mat3_mul(turn->to_from, from_frame));
        size_t row = MRT_VECTOR_COEFFICIENTS * (size_t)t;
        turn_vector(tangent, from->at + MRT_VECTOR_COEFFICIENTS * (size_t)texel * from->stride,
                    from->stride, out->at + row * out->stride, out->stride, from->columns);
    }
    return true;
}

// By measure: one row for each texel, four for each texel, nine for each of p³ probes.
static bool turn_light(struct host *host, const struct turn *turn, int p,
                       const struct matrix_f32 *const from[MRT_MEASURES],
                       struct matrix_f32 out[MRT_MEASURES])
{
    const struct mrt_probe_turn probes = { &turn->from, &turn->to, turn->to_from };
    return turn_rows(host, turn, from[MRT_IRRADIANCE], &out[MRT_IRRADIANCE]) &&
           turn_vectors(host, turn, from[MRT_VECTOR], &out[MRT_VECTOR]) &&
           mrt_turn_probes(host, p, &probes, from[MRT_PROBE], &out[MRT_PROBE]);
}

// ---- bases

static bool make_basis(struct host *host, const struct mrt_level *level,
                       const struct mrt_dictionary *dictionary, int block,
                       struct mrt_basis_input *out)
{
    const struct mrt_cube_place *place = &level->place[block];
    const struct mrt_element *element = &dictionary->element[place->cube];
    const struct turn turn = { element->shape, mrt_level_cell(level, block),
                               place->block_from_cube };
    const struct mrt_retraced *retraced = mrt_level_retraced(level, block);
    const struct matrix_f32 *const light[] = { retraced ? &retraced->u_b : &element->u_b,
                                               retraced ? &retraced->u_vec : &element->u_vec,
                                               &element->u_bvol };
    out->open = level->map->blocks[block].open;
    return turn_columns(host, &turn, &element->t_db, &out->t_db) &&
           turn_light(host, &turn, dictionary->options.block_probes, light, out->u) &&
           turn_rows(host, &turn, &element->l_imp, &out->l_imp);
}

static bool same_basis(const struct mrt_level *level, int i, int j)
{
    const struct mrt_cube_place *a = &level->place[i], *b = &level->place[j];
    return mrt_level_retraced(level, i) == mrt_level_retraced(level, j) && a->cube == b->cube &&
           memcmp(&a->block_from_cube, &b->block_from_cube, sizeof a->block_from_cube) == 0;
}

// Blocks of the same cube, turn and proportions share a basis.
static bool make_bases(struct mrt_level_operators *out, const struct mrt_level *level,
                       const struct mrt_dictionary *dictionary)
{
    for (int b = 0; b < level->map->count; b++) {
        int like = 0;
        while (like < b && !same_basis(level, like, b)) like++;
        if (like < b) {
            out->basis_of_block[b] = out->basis_of_block[like];
            continue;
        }
        int basis = out->input.basis_count++;
        out->basis_of_block[b] = basis;
        if (!make_basis(out->host, level, dictionary, b, &out->bases[basis])) return false;
    }
    return true;
}

static bool make_response(struct mrt_level_operators *out, const struct mrt_dictionary *dictionary,
                          const struct mrt_shape *to, int face, struct mrt_response_input *response)
{
    const int index = mrt_entered_by(to, face);
    const struct mrt_entered *entered = &dictionary->entered[index];
    const struct turn turn = { mrt_entered_shape((enum mrt_maze)dictionary->options.maze,
                                                 dictionary->options.texels, index),
                               *to, mrt_block_from_entry(face) };
    const struct matrix_f32 *const light[] = { &entered->u_r, &entered->u_rvec, &entered->u_rvol };
    return turn_light(out->host, &turn, dictionary->options.block_probes, light, response->u);
}

static bool make_tube_responses(struct mrt_level_operators *out,
                                const struct mrt_dictionary *dictionary)
{
    bool ok = true;
    for (int kind = MRT_BLOCK_STRAIGHT; kind < MRT_BLOCK_KINDS; kind++) {
        struct mrt_block block;
        mrt_block_init(&block, "", (enum mrt_block_kind)kind);
        const struct mrt_shape tube =
            mrt_block_shape(&block, mrt_face_texels(MRT_TUNNEL, dictionary->options.texels));
        for (int f = 0; ok && f < CUBE_FACES; f++)
            if (mrt_shape_is_open(&tube, f))
                ok = make_response(out, dictionary, &tube, f,
                                   &out->responses[mrt_response_of(&block, f)]);
    }
    return ok;
}

static bool make_responses(struct mrt_level_operators *out, const struct mrt_dictionary *dictionary)
{
    if (dictionary->options.maze == MRT_TUNNEL) return make_tube_responses(out, dictionary);
    const struct mrt_shape closed = mrt_cube(dictionary->options.texels, 0);
    bool ok = true;
    for (int f = 0; ok && f < CUBE_FACES; f++)
        ok = make_response(out, dictionary, &closed, f, &out->responses[f]);
    return ok;
}

static void make_pairs(struct mrt_level_operators *out, const struct mrt_level *level)
{
    for (int i = 0; i < level->entry_count; i++) {
        const struct mrt_entry entry = level->entries[i];
        out->openings[i] = (struct mrt_opening_input){
            entry.block, entry.face, mrt_response_of(&level->map->blocks[entry.block], entry.face)
        };
        for (int k = level->first_link[i]; k < level->first_link[i + 1]; k++)
            out->pairs[k] = (struct mrt_pair_input){ i, level->links[k].source,
                                                     level->matrices + level->links[k].matrix };
    }
}

bool mrt_level_operators_init(struct host *host, const struct mrt_level *level,
                              struct mrt_level_operators *out)
{
    const struct mrt_dictionary *dictionary = level->dictionary;
    size_t blocks = (size_t)level->map->count, entries = (size_t)level->entry_count;
    size_t links = (size_t)level->first_link[level->entry_count];
    *out = (struct mrt_level_operators){ .host = host };
    out->bases = host_alloc(host, 2 * blocks, sizeof *out->bases);
    out->responses = host_alloc(host, MRT_RESPONSES, sizeof *out->responses);
    out->basis_of_block = host_alloc(host, blocks, sizeof *out->basis_of_block);
    out->openings = host_alloc(host, entries, sizeof *out->openings);
    out->pairs = host_alloc(host, links, sizeof *out->pairs);
    if (!out->bases || !out->responses || !out->basis_of_block || !out->openings || !out->pairs ||
        !make_bases(out, level, dictionary) || !make_responses(out, dictionary))
        return false;
    make_pairs(out, level);
    struct mrt_runtime_input *input = &out->input;
    input->map = level->map;
    input->k_b = dictionary->options.modes;
    input->k_r = dictionary->options.response_modes;
    input->probes = dictionary->options.block_probes;
    input->bases = out->bases;
    input->basis_of_block = out->basis_of_block;
    input->responses = out->responses;
    input->response_count = MRT_RESPONSES;
    input->openings = out->openings;
    input->opening_count = level->entry_count;
    input->pairs = out->pairs;
    input->pair_count = (int)links;
    input->t_br_stride = level->link_stride;
    return true;
}

static void basis_finish(struct host *host, struct mrt_basis_input *basis)
{
    matrix_f32_finish(host, &basis->t_db);
    for (int m = 0; m < MRT_MEASURES; m++) matrix_f32_finish(host, &basis->u[m]);
    matrix_f32_finish(host, &basis->l_imp);
}

void mrt_response_input_finish(struct host *host, struct mrt_response_input *response)
{
    for (int m = 0; m < MRT_MEASURES; m++) matrix_f32_finish(host, &response->u[m]);
}

void mrt_level_operators_finish(struct mrt_level_operators *operators)
{
    if (!operators->host) return;
    for (int i = 0; i < operators->input.basis_count; i++)
        basis_finish(operators->host, &operators->bases[i]);
    for (int i = 0; operators->responses && i < MRT_RESPONSES; i++)
        mrt_response_input_finish(operators->host, &operators->responses[i]);
    host_free(operators->host, operators->bases);
    host_free(operators->host, operators->responses);
    host_free(operators->host, operators->basis_of_block);
    host_free(operators->host, operators->openings);
    host_free(operators->host, operators->pairs);
}
