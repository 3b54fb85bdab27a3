// Bases, responses, openings and pairs of blocks with clutter.
#include "techniques/mrt/runtime/clutter/delta_operators.h"

#include "techniques/mrt/clutter/probe_sight.h"
#include "techniques/mrt/runtime/clutter/face_order.h"

#include <string.h>

// Rays of a texel that find clutter beyond openings: all texels of a block make a few coefficients.
enum { ENTRY_RAYS = 256 };

struct builder {
    struct mrt_delta_operators *out;
    struct mrt_level_operators *operators;
    const struct mrt_level *level;
    const struct mrt_clutter *clutter;
    const struct mrt_delta_options *options;
    struct trace_scene *objects;
    struct mrt_delta_cache *cache;
    const struct matrix_f32 **l_imp; // of each block
    int *sources;                    // [blocks], of an opening
    int old_opening, old_pair;       // of `operators` that were copied
};

// ---- matrices

static bool copy_light(struct host *host, const struct matrix_f32 from[MRT_MEASURES],
                       struct matrix_f32 to[MRT_MEASURES])
{
    bool ok = true;
    for (int m = 0; ok && m < MRT_MEASURES; m++)
        ok = matrix_f32_copy(host, &from[m], from[m].columns, &to[m]);
    return ok;
}

// U_b + ΔU_b. U_b has the error of other rays, which does not cancel where nothing arrives.
static void add_shadows(struct matrix_f32 *to, const struct mrt_delta *delta, int values)
{
    for (size_t r = 0; r < to->rows; r++)
        for (size_t c = 0; c < to->columns; c++) {
            float *u = &to->at[r * to->stride + c];
            *u = delta->closed[r / (size_t)values] ? 0.0f
                                                   : *u + delta->b.at[r * delta->b.stride + c];
        }
}

static int values_of(enum mrt_measure measure)
{
    static const int values[MRT_MEASURES] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    return values[measure];
}

// ---- bases: U_b + ΔU_b

static void change_basis(const struct builder *s, const struct mrt_block *block,
                         const struct mrt_delta_block *delta, struct mrt_basis_input *basis)
{
    for (int m = 0; m < MRT_MEASURES; m++) {
        const struct mrt_delta *of = &delta->of[m];
        struct matrix_f32 *rows = &basis->u[m];
        if (rows->rows == 0 || !of->inside) continue;
        add_shadows(rows, of, values_of((enum mrt_measure)m));
        if (m == MRT_PROBE)
            mrt_inpaint_probes(rows, s->operators->input.probes, of->inside);
        else
            mrt_inpaint_texels(rows, s->level->resolution, mrt_block_walls(block),
                               values_of((enum mrt_measure)m), of->inside);
    }
}

static bool add_basis(struct builder *s, int block, const struct mrt_delta_block *delta)
{
    struct mrt_level_operators *operators = s->operators;
    struct host *host = operators->host;
    const struct mrt_basis_input *old = &operators->bases[operators->basis_of_block[block]];
    struct mrt_basis_input *basis = &operators->bases[operators->input.basis_count];
    operators->basis_of_block[block] = operators->input.basis_count++;
    basis->open = old->open;
    const bool ok = matrix_f32_copy(host, &old->t_db, old->t_db.columns, &basis->t_db) &&
                    copy_light(host, old->u, basis->u) &&
                    matrix_f32_copy(host, &old->l_imp, old->l_imp.columns, &basis->l_imp);
    if (ok) change_basis(s, &s->level->map->blocks[block], delta, basis);
    s->l_imp[block] = &basis->l_imp;
    return ok;
}

// ---- responses

// Visits each texel of the walls: its index in the closed cube and in the block.
struct wall_texels {
    const struct mrt_block *block;
    int in_face, face, wall;
};

static bool next_wall(struct wall_texels *at)
{
    at->face++;
    while (at->face < CUBE_FACES && !mrt_block_has_wall(at->block, at->face)) at->face++;
    at->wall++;
    return at->face < CUBE_FACES;
}

static struct wall_texels walls_of(const struct builder *s, int block)
{
    return (struct wall_texels){ &s->level->map->blocks[block],
                                 s->level->resolution * s->level->resolution, -1, -1 };
}

static void scale_row(struct matrix_f32 *m, size_t row, float scale)
{
    for (size_t c = 0; c < m->columns; c++) m->at[row * m->stride + c] *= scale;
}

// The share of an opening's light that clutter lets pass, at each point.
static void keep_share(const struct builder *s, int block, int face,
                       const struct mrt_delta_block *delta, enum mrt_measure measure,
                       struct matrix_f32 *rows)
{
    const int values = values_of(measure);
    const float *kept = delta->of[measure].kept[face];
    if (measure == MRT_PROBE) {
        for (size_t r = 0; r < rows->rows; r++) scale_row(rows, r, kept[r / (size_t)values]);
        mrt_inpaint_probes(rows, s->operators->input.probes, delta->of[measure].inside);
        return;
    }
    for (struct wall_texels at = walls_of(s, block); next_wall(&at);) {
        const size_t closed = (size_t)(at.face * at.in_face), own = (size_t)(at.wall * at.in_face);
        for (int i = 0; i < at.in_face * values; i++)
            scale_row(rows, closed * (size_t)values + (size_t)i, kept[own + (size_t)(i / values)]);
        struct matrix_f32 wall = matrix_f32_block(rows, closed * (size_t)values, 0,
                                                  (size_t)(at.in_face * values), rows->columns);
        mrt_inpaint_texels(&wall, s->level->resolution, 1, values, delta->of[measure].inside + own);
    }
}

static bool add_kept_response(struct builder *s, int block, int face,
                              const struct mrt_delta_block *delta,
                              struct mrt_opening_input *opening)
{
    const struct mrt_response_input *old = &s->out->responses[opening->response];
    const int index = s->out->input.response_count++;
    struct mrt_response_input *response = &s->out->responses[index];
    opening->response = index;
    if (!copy_light(s->out->host, old->u, response->u)) return false;
    for (int m = 0; m < MRT_MEASURES; m++)
        if (response->u[m].rows > 0 && delta->of[m].inside)
            keep_share(s, block, face, delta, (enum mrt_measure)m, &response->u[m]);
    return true;
}

// ΔU_c in the rows of a response.
static void copy_faces(const struct builder *s, int block, const struct mrt_delta_block *delta,
                       enum mrt_measure measure, struct matrix_f32 *rows)
{
    const struct matrix_f32 *c = &delta->of[measure].c;
    const bool *inside = delta->of[measure].inside;
    const size_t values = (size_t)values_of(measure), bytes = c->columns * sizeof *c->at;
    if (measure == MRT_PROBE) {
        for (size_t r = 0; r < c->rows; r++)
            memcpy(rows->at + r * rows->stride, c->at + r * c->stride, bytes);
        mrt_inpaint_probes(rows, s->operators->input.probes, inside);
        return;
    }
    for (struct wall_texels at = walls_of(s, block); next_wall(&at);) {
        const size_t count = (size_t)at.in_face * values;
        const size_t closed = (size_t)at.face * count, own = (size_t)at.wall * count;
        for (size_t i = 0; i < count; i++)
            memcpy(rows->at + (closed + i) * rows->stride, c->at + (own + i) * c->stride, bytes);
        struct matrix_f32 wall = matrix_f32_block(rows, closed, 0, count, rows->columns);
        mrt_inpaint_texels(&wall, s->level->resolution, 1, (int)values,
                           inside + at.wall * at.in_face);
    }
}

static bool add_face_response(struct builder *s, int block, const struct mrt_delta_block *delta,
                              int index)
{
    for (int m = 0; m < MRT_MEASURES; m++) {
        const struct matrix_f32 *sizes = &s->operators->responses[0].u[m];
        struct matrix_f32 *rows = &s->out->responses[index].u[m];
        if (!matrix_f32_init(s->out->host, rows, sizes->rows, sizes->columns)) return false;
        if (rows->rows > 0 && delta->of[m].inside)
            copy_faces(s, block, delta, (enum mrt_measure)m, rows);
    }
    return true;
}

// ---- openings

static struct mrt_opening_input *new_opening(struct builder *s, struct mrt_opening_input opening)
{
    struct mrt_opening_input *to = &s->out->openings[s->out->input.opening_count++];
    *to = opening;
    return to;
}

// T_b→r is stored transposed: k_b rows of t_br_stride.
static bool add_pair(struct builder *s, int opening, int source, const struct matrix_f32 *of_b)
{
    const size_t k_b = of_b->columns, stride = (size_t)s->operators->input.t_br_stride;
    struct matrix_f32 *matrix = &s->out->gathered[s->out->gathered_count++];
    if (!matrix_f32_init(s->out->host, matrix, 1, k_b * stride)) return false;
    for (size_t f = 0; f < of_b->rows; f++)
        for (size_t m = 0; m < k_b; m++)
            matrix->at[m * stride + f] = of_b->at[f * of_b->stride + m];
    s->out->pairs[s->out->input.pair_count++] =
        (struct mrt_pair_input){ opening, source, matrix->at };
    return true;
}

// of_c: coefficients of the opening × faces. Without any light there is no pair.
static bool add_face_pair(struct builder *s, int opening, int source, const struct matrix_f32 *of_c)
{
    bool any = false;
    for (size_t i = 0; i < of_c->rows * of_c->columns; i++)
        any = any || of_c->at[i / of_c->columns * of_c->stride + i % of_c->columns] != 0.0f;
    if (!any) return true;
    struct mrt_face_pair_input *pair = &s->out->face_pairs[s->out->face_pair_count++];
    *pair = (struct mrt_face_pair_input){ .opening = opening, .source = source };
    if (!matrix_f32_init(s->out->host, &pair->of_c, of_c->columns, (size_t)s->operators->input.k_r))
        return false;
    for (size_t r = 0; r < of_c->rows; r++)
        for (size_t f = 0; f < of_c->columns; f++)
            pair->of_c.at[f * pair->of_c.stride + r] = of_c->at[r * of_c->stride + f];
    return true;
}

static int pairs_of_opening(const struct mrt_runtime_input *input, int opening, int first)
{
    int count = 0;
    while (first + count < input->pair_count && input->pairs[first + count].opening == opening)
        count++;
    return count;
}

// Without clutter in any of the blocks that send light the entry is empty.
static bool trace_entry(struct builder *s, int index, int pairs, const struct mrt_delta_entry **out)
{
    const struct mrt_opening_input *opening = &s->operators->input.openings[index];
    const struct mrt_delta_entry_input input = {
        .map = s->level->map,
        .l_imp = s->l_imp,
        .resolution = s->level->resolution,
        .clutter = s->clutter,
        .objects = s->objects,
        .rays = ENTRY_RAYS,
        .depth = s->options->depth,
        .block = opening->block,
        .face = opening->face,
        .u_r = &s->operators->responses[opening->response].u[MRT_IRRADIANCE],
        .sources = s->sources,
        .source_count = pairs,
        .stop = s->options->stop
    };
    bool any = false;
    for (int i = 0; i < pairs; i++) {
        int first;
        s->sources[i] = s->operators->input.pairs[s->old_pair + i].source;
        any = any || mrt_faces_of_block(s->clutter, s->sources[i], &first) > 0;
    }
    static const struct mrt_delta_entry empty = { 0 };
    *out = any ? mrt_kept_entry(s->cache, &input) : &empty;
    return *out;
}

static bool add_opening_pairs(struct builder *s, int opening)
{
    const struct mrt_runtime_input *old = &s->operators->input;
    const int count = pairs_of_opening(old, s->old_opening, s->old_pair);
    const struct mrt_delta_entry *entry;
    bool ok = trace_entry(s, s->old_opening, count, &entry);
    for (int i = 0; ok && i < count; i++) {
        const struct mrt_pair_input *pair = &old->pairs[s->old_pair + i];
        const struct mrt_delta_source *source = entry->count > 0 ? &entry->sources[i] : NULL;
        if (source && source->hidden && s->options->occlusion) {
            ok = add_pair(s, opening, pair->source, &source->b);
        } else {
            struct mrt_pair_input *to = &s->out->pairs[s->out->input.pair_count++];
            *to = *pair;
            to->opening = opening;
        }
        if (ok && source && source->c.columns > 0 && s->options->reflection)
            ok = add_face_pair(s, opening, pair->source, &source->c);
    }
    s->old_pair += count;
    return ok;
}

static bool add_openings(struct builder *s, int block, const struct mrt_delta_block *delta)
{
    const struct mrt_runtime_input *old = &s->operators->input;
    bool ok = true;
    while (ok && s->old_opening < old->opening_count &&
           old->openings[s->old_opening].block == block) {
        const int index = s->out->input.opening_count;
        struct mrt_opening_input *to = new_opening(s, old->openings[s->old_opening]);
        if (delta->touched && s->options->occlusion)
            ok = add_kept_response(s, block, to->face, delta, to);
        ok = ok && add_opening_pairs(s, index);
        s->old_opening++;
    }
    return ok;
}

// ---- the opening of clutter

// Light of the faces of all blocks on those of one.
static bool add_couplings(struct builder *s, int opening, const struct matrix_f32 *of_c)
{
    bool ok = true;
    for (int b = 0; ok && b < s->level->map->count; b++) {
        int first;
        const int faces = mrt_faces_of_block(s->clutter, b, &first);
        if (faces == 0) continue;
        const struct matrix_f32 part =
            matrix_f32_block(of_c, 0, (size_t)first, of_c->rows, (size_t)faces);
        ok = add_face_pair(s, opening, b, &part);
    }
    return ok;
}

static void add_faces(struct builder *s, int opening, const struct mrt_delta_block *delta,
                      const struct mrt_clutter_texel *texels)
{
    struct mrt_clutter_input *clutter = &s->out->clutter;
    s->out->clutter_openings[clutter->opening_count++] = opening;
    for (int i = 0; i < delta->face_count; i++) {
        const struct mrt_clutter_face *from = &s->clutter->faces[delta->first_face + i];
        struct mrt_clutter_face_input *to = &s->out->faces[clutter->face_count++];
        *to = (struct mrt_clutter_face_input){ .opening = opening,
                                               .slot = i,
                                               .first_texel = (int)from->first_texel,
                                               .texel_count = (int)from->texel_count };
        float area = 0.0f;
        for (int t = to->first_texel; t < to->first_texel + to->texel_count; t++) {
            to->reflectance =
                glms_vec3_muladds(texels[t].at.reflectance, texels[t].area_m2, to->reflectance);
            area += texels[t].area_m2;
        }
        to->reflectance = glms_vec3_divs(to->reflectance, area);
    }
}

static bool add_clutter(struct builder *s, int block, const struct mrt_delta_block *delta,
                        const struct mrt_clutter_texel *texels)
{
    const int opening = s->out->input.opening_count, response = s->out->input.response_count++;
    const struct mrt_gather_input input = { .map = s->level->map,
                                            .l_imp = s->l_imp,
                                            .resolution = s->level->resolution,
                                            .clutter = s->clutter,
                                            .objects = s->objects,
                                            .rays = s->options->rays,
                                            .depth = s->options->depth,
                                            .stop = s->options->stop };
    new_opening(s, (struct mrt_opening_input){ block, -1, response });
    if (!add_face_response(s, block, delta, response)) return false;
    const struct mrt_gather_faces *gathered = mrt_kept_gather(s->cache, &input, block);
    bool ok = gathered;
    for (int i = 0; ok && i < gathered->count; i++)
        ok = add_pair(s, opening, gathered->from[i].source, &gathered->from[i].of_b);
    ok = ok && add_couplings(s, opening, &gathered->of_c);
    if (ok) add_faces(s, opening, delta, texels);
    return ok;
}

static bool add_transfer(struct builder *s, int block, int first_opening)
{
    const struct mrt_runtime_input *input = &s->out->input;
    const struct mrt_clutter_transfer_input how = { .map = s->level->map,
                                                    .l_imp = s->l_imp[block],
                                                    .resolution = s->level->resolution,
                                                    .clutter = s->clutter,
                                                    .objects = s->objects,
                                                    .rays = s->options->rays,
                                                    .stop = s->options->stop };
    return mrt_clutter_atlas_add(&s->out->atlas, s->operators, s->cache, &how, block,
                                 s->out->openings + first_opening,
                                 input->opening_count - first_opening);
}

static size_t voxels_of(const struct mrt_level_operators *operators)
{
    const size_t edge =
        operators->input.probes > 0 ? (size_t)mrt_sight_edge(operators->input.probes) : 0;
    return edge * edge * edge;
}

static void add_sight(struct builder *s, int block, const struct mrt_delta_block *delta)
{
    struct mrt_runtime_input *input = &s->out->input;
    const size_t voxels = voxels_of(s->operators);
    if (!delta->sight) return;
    input->sight = s->out->sight;
    s->out->sight[block] = (uint32_t)input->sight_count;
    memcpy(s->out->sight + input->sight_count, delta->sight, voxels * sizeof *delta->sight);
    input->sight_count += voxels;
}

static bool add_block(struct builder *s, int block, const struct mrt_clutter_texel *texels)
{
    const int first_opening = s->out->input.opening_count;
    const struct mrt_block *at = &s->level->map->blocks[block];
    const struct mrt_delta_input input = { .block = at,
                                           .index = block,
                                           .shape = mrt_level_cell(s->level, block),
                                           .l_imp = s->l_imp[block],
                                           .clutter = s->clutter,
                                           .objects = s->objects,
                                           .bounds = mrt_clutter_bounds_in(s->clutter, at),
                                           .rays = s->options->rays,
                                           .probes = s->operators->input.probes,
                                           .stop = s->options->stop };
    const struct mrt_delta_block *delta = mrt_kept_delta(s->cache, &input);
    bool ok = delta;
    if (ok && delta->touched && s->options->occlusion) {
        ok = add_basis(s, block, delta);
        add_sight(s, block, delta);
    }
    ok = ok && add_openings(s, block, delta);
    if (ok && delta->face_count > 0 && s->options->reflection)
        ok = add_clutter(s, block, delta, texels);
    if (ok && delta->face_count > 0 && s->options->gather)
        ok = add_transfer(s, block, first_opening);
    return ok;
}

// ---- all of it

static bool allocate(struct mrt_delta_operators *out, const struct mrt_level_operators *operators,
                     int faces)
{
    const struct mrt_runtime_input *old = &operators->input;
    const size_t blocks = (size_t)old->map->count, openings = (size_t)old->opening_count;
    const size_t pairs = (size_t)old->pair_count;
    struct host *host = out->host;
    out->responses = host_alloc(host, MRT_RESPONSES + openings + blocks, sizeof *out->responses);
    out->openings = host_alloc(host, openings + blocks, sizeof *out->openings);
    out->pairs = host_alloc(host, pairs + blocks * blocks, sizeof *out->pairs);
    out->gathered = host_alloc(host, pairs + blocks * blocks, sizeof *out->gathered);
    out->faces = host_alloc(host, (size_t)faces, sizeof *out->faces);
    out->clutter_openings = host_alloc(host, blocks, sizeof *out->clutter_openings);
    out->face_pairs = host_alloc(host, pairs + blocks * blocks, sizeof *out->face_pairs);
    out->sight = host_alloc(host, blocks * (1 + voxels_of(operators)), sizeof *out->sight);
    out->input.sight_count = blocks;
    if (!mrt_clutter_atlas_init(&out->atlas, host, (int)blocks)) return false;
    return out->responses && out->openings && out->pairs && out->gathered && out->faces &&
           out->clutter_openings && out->face_pairs && out->sight;
}

static void finish_input(struct mrt_delta_operators *out, struct mrt_level_operators *operators,
                         const struct mrt_clutter *clutter, const struct mrt_clutter_texel *texels)
{
    out->input.basis_count = operators->input.basis_count;
    out->input.responses = out->responses;
    out->input.openings = out->openings;
    out->input.pairs = out->pairs;
    out->clutter.texels = texels;
    out->clutter.texel_count = (int)clutter->charts.side_texel_count;
    out->clutter.faces = out->faces;
    out->clutter.openings = out->clutter_openings;
    out->clutter.pairs = out->face_pairs;
    out->clutter.pair_count = out->face_pair_count;
    out->clutter.atlas = out->atlas.input;
    if (out->clutter.opening_count > 0 || out->atlas.input.count > 0)
        out->input.clutter = &out->clutter;
}

bool mrt_delta_operators_init(struct mrt_delta_operators *out, struct host *host,
                              struct mrt_level_operators *operators, const struct mrt_level *level,
                              const struct mrt_clutter *clutter,
                              const struct mrt_clutter_texel *texels, struct mrt_delta_cache *cache,
                              const struct mrt_delta_options *options)
{
    const int blocks = level->map->count;
    struct builder s = { .out = out,
                         .operators = operators,
                         .level = level,
                         .clutter = clutter,
                         .cache = cache,
                         .options = options };
    *out = (struct mrt_delta_operators){ .host = host, .input = operators->input };
    out->input.opening_count = out->input.pair_count = 0;
    s.objects = trace_scene_create(host, &clutter->objects.pose);
    s.l_imp = host_alloc(host, (size_t)blocks, sizeof *s.l_imp);
    s.sources = host_alloc(host, (size_t)blocks, sizeof *s.sources);
    bool ok = s.objects && s.l_imp && s.sources && allocate(out, operators, clutter->face_count);
    for (int i = 0; ok && i < MRT_RESPONSES; i++) out->responses[i] = operators->responses[i];
    out->shared_responses = MRT_RESPONSES;
    for (int b = 0; ok && b < blocks; b++)
        s.l_imp[b] = &operators->bases[operators->basis_of_block[b]].l_imp;
    for (int b = 0; ok && b < blocks; b++) ok = add_block(&s, b, texels);
    trace_scene_destroy(s.objects);
    host_free(host, s.l_imp);
    host_free(host, s.sources);
    ok = ok && (!options->gather || mrt_clutter_atlas_place(&out->atlas, clutter));
    if (ok) finish_input(out, operators, clutter, texels);
    ok = ok && mrt_order_faces(out);
    if (!ok) mrt_delta_operators_finish(out);
    return ok;
}

void mrt_delta_operators_finish(struct mrt_delta_operators *out)
{
    if (!out->host) return;
    for (int i = out->shared_responses; out->responses && i < out->input.response_count; i++)
        mrt_response_input_finish(out->host, &out->responses[i]);
    for (int i = 0; i < out->gathered_count; i++) matrix_f32_finish(out->host, &out->gathered[i]);
    mrt_clutter_atlas_finish(&out->atlas);
    host_free(out->host, out->responses);
    host_free(out->host, out->openings);
    host_free(out->host, out->pairs);
    host_free(out->host, out->gathered);
    host_free(out->host, out->faces);
    host_free(out->host, out->clutter_openings);
    host_free(out->host, out->sight);
    for (int i = 0; i < out->face_pair_count; i++)
        matrix_f32_finish(out->host, &out->face_pairs[i].of_c);
    host_free(out->host, out->face_pairs);
    *out = (struct mrt_delta_operators){ 0 };
}
