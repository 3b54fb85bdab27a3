// Operators of the dictionary in the frames of the blocks of a level.
#include "operators.h"

#include "techniques/mrt/level/opening_view.h"

#include <string.h>

// ---- bases

static bool turn_all(const struct mrt_operators *o, const struct mrt_rotation *turn,
                     const struct matrix_f32 *const from[MRT_MEASURES],
                     struct matrix_f32 out[MRT_MEASURES])
{
    bool ok = true;
    for (int m = 0; ok && m < MRT_MEASURES; m++)
        ok = mrt_rotate_light(o->host, turn, o->probes, (enum mrt_measure)m, from[m], &out[m]);
    return ok;
}

static bool make_basis(const struct mrt_operators *o, const struct mrt_level *level, int block,
                       struct mrt_block_basis *out)
{
    const struct mrt_cube_place *place = &level->place[block];
    const struct mrt_element *element = &level->dictionary->element[place->cube];
    const struct mrt_rotation turn = { element->shape, mrt_level_cell(level, block),
                                       place->block_from_cube };
    const struct mrt_retraced *retraced = mrt_level_retraced(level, block);
    const struct matrix_f32 *const light[] = { retraced ? &retraced->u_b : &element->u_b,
                                               retraced ? &retraced->u_vec : &element->u_vec,
                                               &element->u_bvol };
    return mrt_rotate_columns(o->host, &turn, retraced ? &retraced->t_db : &element->t_db,
                              &out->t_db) &&
           turn_all(o, &turn, light, out->u) &&
           mrt_rotate_light(o->host, &turn, 0, MRT_IRRADIANCE, &element->l_imp, &out->l_imp);
}

static bool same_basis(const struct mrt_level *level, int i, int j)
{
    const struct mrt_cube_place *a = &level->place[i], *b = &level->place[j];
    return mrt_level_retraced(level, i) == mrt_level_retraced(level, j) && a->cube == b->cube &&
           memcmp(&a->block_from_cube, &b->block_from_cube, sizeof a->block_from_cube) == 0;
}

// Blocks of the same cube, turn and proportions share a basis.
static bool make_bases(struct mrt_operators *o, const struct mrt_level *level)
{
    for (int b = 0; b < level->map->count; b++) {
        int like = 0;
        while (like < b && !same_basis(level, like, b)) like++;
        o->basis_of_block[b] = like < b ? o->basis_of_block[like] : o->basis_count++;
        if (like == b && !make_basis(o, level, b, &o->bases[o->basis_count - 1])) return false;
    }
    return true;
}

// ---- responses

static bool make_response(const struct mrt_operators *o, const struct mrt_dictionary *dictionary,
                          const struct mrt_shape *to, int face, struct mrt_block_response *response)
{
    const int index = mrt_entered_by(to, face);
    const struct mrt_entered *entered = &dictionary->entered[index];
    const struct mrt_rotation turn = { mrt_entered_shape((enum mrt_maze)dictionary->options.maze,
                                                         dictionary->options.texels, index),
                                       *to, mrt_block_from_entry(face) };
    const struct matrix_f32 *const light[] = { &entered->u_r, &entered->u_rvec, &entered->u_rvol };
    return turn_all(o, &turn, light, response->u);
}

// At all faces of a closed cube, and at the ends of each tube.
static bool make_responses(struct mrt_operators *o, const struct mrt_level *level)
{
    const bool tubes = level->maze == MRT_TUNNEL;
    const int first = tubes ? MRT_BLOCK_STRAIGHT : MRT_BLOCK_CUBE;
    for (int kind = first; kind < (tubes ? MRT_BLOCK_KINDS : MRT_BLOCK_STRAIGHT); kind++) {
        struct mrt_block block;
        mrt_block_init(&block, "", (enum mrt_block_kind)kind);
        const struct mrt_shape shape = mrt_block_shape(&block, level->resolution);
        for (int f = 0; f < CUBE_FACES; f++)
            if ((!tubes || mrt_shape_is_open(&shape, f)) &&
                !make_response(o, level->dictionary, &shape, f,
                               &o->responses[mrt_response_of(&block, f)]))
                return false;
    }
    return true;
}

// ---- openings

static bool make_pairs(struct mrt_operators *o, const struct mrt_level *level, int entry,
                       struct mrt_opening *opening)
{
    const int first = level->first_link[entry], end = level->first_link[entry + 1];
    opening->pairs = host_alloc(o->host, (size_t)(end - first), sizeof *opening->pairs);
    if (!opening->pairs) return false;
    for (int k = first; k < end; k++) {
        struct mrt_pair *pair = &opening->pairs[opening->pair_count++];
        const struct matrix_f32 t_br = { level->matrices + level->links[k].matrix, (size_t)o->k_b,
                                         (size_t)o->k_r, (size_t)level->link_stride };
        pair->source = level->links[k].source;
        if (!matrix_f32_copy(o->host, &t_br, t_br.columns, &pair->of_b)) return false;
    }
    return true;
}

// Room of a device's buffers: openings beyond these have the cube's.
enum { MOST_SCALED = 96 };

// The response of an opening of a block that is no cube, from that of a cube. Probes keep the
// latter, as in their bases.
static bool add_scaled_response(struct mrt_operators *o, const struct mrt_level *level,
                                const struct mrt_entry *entry, int of_cube)
{
    const struct mrt_block *block = &level->map->blocks[entry->block];
    const struct mrt_shape closed = mrt_cube(level->resolution, 0);
    const size_t texels = (size_t)mrt_shape_texels(&closed);
    struct mrt_block_response *to = &o->responses[o->response_count++];
    float *ratios = host_alloc(o->host, texels, sizeof *ratios);
    bool ok = ratios;
    if (ok)
        mrt_opening_ratios(&closed, mrt_warp_jacobian(block->corner, GLMS_VEC3_ZERO), entry->face,
                           ratios);
    for (int m = 0; ok && m < MRT_MEASURES; m++) {
        const struct matrix_f32 *from = &o->responses[of_cube].u[m];
        if (from->rows == 0) continue;
        ok = matrix_f32_copy(o->host, from, from->columns, &to->u[m]);
        const size_t values = (size_t)mrt_values_of((enum mrt_measure)m);
        for (size_t i = 0; ok && m != MRT_PROBE && i < texels * values * from->columns; i++)
            to->u[m].at[i / from->columns * to->u[m].stride + i % from->columns] *=
                ratios[i / (values * from->columns)];
    }
    host_free(o->host, ratios);
    return ok;
}

// Blocks of the same proportions and turn share the responses of their openings.
static bool scale_response(struct mrt_operators *o, const struct mrt_level *level, int entry)
{
    struct mrt_opening *to = &o->openings[entry];
    if (!mrt_level_retraced(level, to->block)) return true;
    for (int i = 0; i < entry; i++) {
        const struct mrt_opening *like = &o->openings[i];
        if (like->face != to->face || !same_basis(level, like->block, to->block)) continue;
        to->response = like->response;
        return true;
    }
    if (o->response_count >= MRT_RESPONSES + MOST_SCALED) return true;
    const int of_cube = to->response;
    to->response = o->response_count;
    return add_scaled_response(o, level, &level->entries[entry], of_cube);
}

static bool make_openings(struct mrt_operators *o, const struct mrt_level *level)
{
    for (int i = 0; i < level->entry_count; i++) {
        const struct mrt_entry entry = level->entries[i];
        struct mrt_opening *to = &o->openings[o->opening_count++];
        to->block = entry.block;
        to->face = entry.face;
        to->response = mrt_response_of(&level->map->blocks[entry.block], entry.face);
        if (!scale_response(o, level, i) || !make_pairs(o, level, i, to)) return false;
    }
    return true;
}

bool mrt_operators_init(struct mrt_operators *out, struct host *host, const struct mrt_level *level)
{
    const struct mrt_dictionary_options *options = &level->dictionary->options;
    const size_t blocks = (size_t)level->map->count, entries = (size_t)level->entry_count;
    *out = (struct mrt_operators){ .host = host,
                                   .k_b = options->modes,
                                   .k_r = options->response_modes,
                                   .probes = options->block_probes,
                                   .response_count = MRT_RESPONSES };
    // Each block may get a basis and an opening of its own, each opening a response, with clutter
    // a second one.
    out->bases = host_alloc(host, 2 * blocks, sizeof *out->bases);
    out->basis_of_block = host_alloc(host, blocks, sizeof *out->basis_of_block);
    out->responses = host_alloc(host, MRT_RESPONSES + 2 * entries + blocks, sizeof *out->responses);
    out->openings = host_alloc(host, entries + blocks, sizeof *out->openings);
    return out->bases && out->basis_of_block && out->responses && out->openings &&
           make_bases(out, level) && make_responses(out, level) && make_openings(out, level);
}

static void finish_light(struct host *host, struct matrix_f32 u[MRT_MEASURES])
{
    for (int m = 0; m < MRT_MEASURES; m++) matrix_f32_finish(host, &u[m]);
}

static void finish_opening(struct host *host, struct mrt_opening *opening)
{
    for (int i = 0; i < opening->pair_count; i++) {
        matrix_f32_finish(host, &opening->pairs[i].of_b);
        matrix_f32_finish(host, &opening->pairs[i].of_c);
    }
    matrix_f32_finish(host, &opening->at_clutter);
    host_free(host, opening->pairs);
    host_free(host, opening->faces);
}

void mrt_operators_finish(struct mrt_operators *o)
{
    struct host *host = o->host;
    if (!host) return;
    for (int i = 0; i < o->basis_count; i++) {
        matrix_f32_finish(host, &o->bases[i].t_db);
        finish_light(host, o->bases[i].u);
        matrix_f32_finish(host, &o->bases[i].l_imp);
    }
    for (int i = 0; o->responses && i < o->response_count; i++)
        finish_light(host, o->responses[i].u);
    for (int i = 0; i < o->opening_count; i++) finish_opening(host, &o->openings[i]);
    for (int i = 0; i < o->row_count; i++) matrix_f32_finish(host, &o->rows[i].u_b);
    host_free(host, o->bases);
    host_free(host, o->basis_of_block);
    host_free(host, o->responses);
    host_free(host, o->openings);
    host_free(host, o->sight);
    host_free(host, o->rows);
    host_free(host, o->map_source);
    *o = (struct mrt_operators){ 0 };
}

size_t mrt_pair_count(const struct mrt_operators *operators)
{
    size_t count = 0;
    for (int i = 0; i < operators->opening_count; i++)
        for (int k = 0; k < operators->openings[i].pair_count; k++)
            count += operators->openings[i].pairs[k].of_b.rows > 0;
    return count;
}

const struct mrt_clutter_rows *mrt_rows_of(const struct mrt_operators *o, int block)
{
    for (int i = 0; i < o->row_count; i++)
        if (o->rows[i].block == block) return &o->rows[i];
    return NULL;
}
