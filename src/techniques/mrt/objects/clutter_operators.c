// Bases, responses, openings and pairs of blocks with clutter.
#include "techniques/mrt/objects/clutter_operators.h"

#include "techniques/mrt/objects/delta.h"

#include <string.h>

struct builder {
    struct mrt_operators *to;
    const struct mrt_level *level;
    const struct mrt_geometry_texel *texels;
    const struct mrt_clutter_changes *changes;
    struct mrt_clutter_rays rays; // of the next two
    struct trace_scene *objects;
    const struct matrix_f32 **l_imp, **t_db; // [blocks]
    struct mrt_delta_cache *cache;
    int *sources; // [blocks], of an opening
    bool *inside; // of each texel of the clutter, in its order
};

// ---- rows of light

static bool copy_light(struct host *host, const struct matrix_f32 from[MRT_MEASURES],
                       struct matrix_f32 to[MRT_MEASURES])
{
    bool ok = true;
    for (int m = 0; ok && m < MRT_MEASURES; m++)
        ok = matrix_f32_copy(host, &from[m], from[m].columns, &to[m]);
    return ok;
}

// Rows of a measure that are one inpainted grid: those of a wall, or of all probes.
struct grid_rows {
    size_t own, closed, count; // first row in the block and in the closed cube; rows
};

// Calls `visit` for the rows of each wall of a block, or for those of its probes.
static void for_grids(const struct builder *s, int block, enum mrt_measure measure,
                      void (*visit)(void *user, const struct grid_rows *rows), void *user)
{
    const size_t values = (size_t)mrt_values_of(measure);
    const size_t wall = (size_t)(s->rays.resolution * s->rays.resolution) * values;
    if (measure == MRT_PROBE) {
        const size_t probes = (size_t)(s->to->probes * s->to->probes * s->to->probes);
        visit(user, &(struct grid_rows){ 0, 0, probes * values });
        return;
    }
    for (size_t f = 0, own = 0; f < CUBE_FACES; f++)
        if (mrt_block_has_wall(&s->level->map->blocks[block], (int)f))
            visit(user, &(struct grid_rows){ wall * own++, wall * f, wall });
}

// Change by clutter in the rows of a measure.
struct change {
    const struct builder *s;
    const struct mrt_delta *delta;
    enum mrt_measure measure;
    int face;                // of the opening
    struct matrix_f32 *rows; // of the basis or of the response
};

// first: of the grid, in `rows`.
static void inpaint(const struct change *at, const struct grid_rows *grid, size_t first)
{
    const int values = mrt_values_of(at->measure);
    const bool *inside = at->delta->inside + grid->own / (size_t)values;
    struct matrix_f32 rows = matrix_f32_block(at->rows, first, 0, grid->count, at->rows->columns);
    if (at->measure == MRT_PROBE)
        mrt_inpaint(&rows, at->s->to->probes, at->s->to->probes, values, inside);
    else
        mrt_inpaint(&rows, at->s->rays.resolution, 1, values, inside);
}

// U_b past clutter.
static void replace_light(void *user, const struct grid_rows *grid)
{
    const struct change *at = user;
    for (size_t r = grid->own; r < grid->own + grid->count; r++)
        for (size_t c = 0; c < at->rows->columns; c++)
            at->rows->at[r * at->rows->stride + c] = at->delta->b.at[r * at->delta->b.stride + c];
    inpaint(at, grid, grid->own);
}

// The share of an opening's light that clutter lets pass, at each point.
static void keep_share(void *user, const struct grid_rows *grid)
{
    const struct change *at = user;
    const size_t values = (size_t)mrt_values_of(at->measure);
    for (size_t i = 0; i < grid->count; i++)
        for (size_t c = 0; c < at->rows->columns; c++)
            at->rows->at[(grid->closed + i) * at->rows->stride + c] *=
                at->delta->kept[(grid->own + i) / values][at->face];
    inpaint(at, grid, grid->closed);
}

// ΔU_c in the rows of a response.
static void copy_faces(void *user, const struct grid_rows *grid)
{
    const struct change *at = user;
    const struct matrix_f32 *c = &at->delta->c;
    for (size_t i = 0; i < grid->count; i++)
        memcpy(at->rows->at + (grid->closed + i) * at->rows->stride,
               c->at + (grid->own + i) * c->stride, c->columns * sizeof *c->at);
    inpaint(at, grid, grid->closed);
}

// `visit` changes the rows of each measure. face: of an opening, −1: none.
static void change_light(const struct builder *s, int block, const struct mrt_delta_block *delta,
                         int face, void (*visit)(void *user, const struct grid_rows *grid),
                         struct matrix_f32 light[MRT_MEASURES])
{
    for (int m = 0; m < MRT_MEASURES; m++) {
        struct change at = { s, &delta->of[m], (enum mrt_measure)m, face, &light[m] };
        if (light[m].rows > 0 && at.delta->inside) for_grids(s, block, at.measure, visit, &at);
    }
}

// ---- bases and responses

static bool replace_basis(struct builder *s, int block, const struct mrt_delta_block *delta)
{
    struct mrt_operators *to = s->to;
    const struct mrt_block_basis *old = &to->bases[to->basis_of_block[block]];
    struct mrt_block_basis *basis = &to->bases[to->basis_count];
    to->basis_of_block[block] = to->basis_count++;
    if (!matrix_f32_copy(to->host, &delta->t_db, delta->t_db.columns, &basis->t_db) ||
        !copy_light(to->host, old->u, basis->u))
        return false;
    change_light(s, block, delta, -1, replace_light, basis->u);
    return true;
}

static bool replace_response(struct builder *s, const struct mrt_delta_block *delta,
                             struct mrt_opening *opening)
{
    const struct mrt_block_response *old = &s->to->responses[opening->response];
    opening->response = s->to->response_count++;
    struct mrt_block_response *response = &s->to->responses[opening->response];
    if (!copy_light(s->to->host, old->u, response->u)) return false;
    change_light(s, opening->block, delta, opening->face, keep_share, response->u);
    return true;
}

static bool add_face_response(struct builder *s, const struct mrt_delta_block *delta,
                              struct mrt_opening *opening)
{
    opening->response = s->to->response_count++;
    struct matrix_f32 *u = s->to->responses[opening->response].u;
    for (int m = 0; m < MRT_MEASURES; m++) {
        const struct matrix_f32 *sizes = &s->to->responses[0].u[m];
        if (!matrix_f32_init(s->to->host, &u[m], sizes->rows, sizes->columns)) return false;
    }
    change_light(s, opening->block, delta, -1, copy_faces, u);
    return true;
}

// ---- pairs

// Coefficients of the opening × columns become columns × k_r.
static bool transpose(const struct builder *s, const struct matrix_f32 *from,
                      struct matrix_f32 *out)
{
    if (!matrix_f32_init(s->to->host, out, from->columns, (size_t)s->to->k_r)) return false;
    for (size_t r = 0; r < from->rows; r++)
        for (size_t c = 0; c < from->columns; c++)
            out->at[c * out->stride + r] = from->at[r * from->stride + c];
    return true;
}

static bool has_light(const struct matrix_f32 *m)
{
    for (size_t i = 0; i < m->rows * m->columns; i++)
        if (m->at[i / m->columns * m->stride + i % m->columns] != 0.0f) return true;
    return false;
}

static bool change_pair(const struct builder *s, const struct mrt_delta_source *source,
                        struct mrt_pair *pair)
{
    bool ok = true;
    if (source->hidden && s->changes->occlusion) {
        matrix_f32_finish(s->to->host, &pair->of_b);
        ok = transpose(s, &source->b, &pair->of_b);
    }
    if (ok && s->changes->reflection && has_light(&source->c))
        ok = transpose(s, &source->c, &pair->of_c);
    return ok;
}

// Without clutter in any of the blocks that send light the pairs stay.
static bool change_pairs(struct builder *s, const struct mrt_opening *opening)
{
    const int shared = mrt_response_of(&s->level->map->blocks[opening->block], opening->face);
    const struct mrt_entered_opening entered = { opening->block, opening->face,
                                                 &s->to->responses[shared].u[MRT_IRRADIANCE],
                                                 s->sources, opening->pair_count };
    bool any = false;
    for (int i = 0; i < opening->pair_count; i++) {
        int first;
        s->sources[i] = opening->pairs[i].source;
        any = any || mrt_faces_of_block(s->rays.clutter, s->sources[i], &first) > 0;
    }
    if (!any) return true;
    const struct mrt_delta_entry *entry = mrt_kept_entry(s->cache, &s->rays, &entered);
    bool ok = entry;
    for (int i = 0; ok && i < opening->pair_count; i++)
        ok = change_pair(s, &entry->sources[i], &opening->pairs[i]);
    return ok;
}

// ---- the opening that is clutter

// Light of a block on the faces of another, or on its own.
static bool add_face_pair(struct builder *s, const struct mrt_gather_faces *gathered, int source,
                          struct mrt_opening *opening)
{
    const struct matrix_f32 *of_c = &gathered->of_c;
    struct mrt_pair *pair = &opening->pairs[opening->pair_count];
    int first;
    const int faces = mrt_faces_of_block(s->rays.clutter, source, &first);
    const struct matrix_f32 part =
        matrix_f32_block(of_c, 0, (size_t)first, of_c->rows, (size_t)faces);
    bool ok = true, any = false;
    pair->source = source;
    for (int i = 0; ok && i < gathered->count; i++) {
        if (gathered->from[i].source != source) continue;
        ok = transpose(s, &gathered->from[i].of_b, &pair->of_b);
        any = true;
    }
    if (ok && faces > 0 && has_light(&part)) {
        ok = transpose(s, &part, &pair->of_c);
        any = true;
    }
    opening->pair_count += any;
    return ok;
}

static void fill_face(const struct builder *s, const struct mrt_clutter_face *from, int slot,
                      struct mrt_opening_face *to)
{
    float area = 0.0f;
    *to = (struct mrt_opening_face){ .slot = slot,
                                     .first_texel = (int)from->first_texel,
                                     .texel_count = (int)from->texel_count };
    for (int t = to->first_texel; t < to->first_texel + to->texel_count; t++) {
        const struct mrt_geometry_texel *texel = &s->texels[t];
        to->reflectance = glms_vec3_muladds(texel->reflectance, texel->area_m2, to->reflectance);
        area += texel->area_m2;
    }
    to->reflectance = glms_vec3_divs(to->reflectance, area);
}

// Inserted before opening `at`.
static bool add_clutter_opening(struct builder *s, int block, int at,
                                const struct mrt_delta_block *delta)
{
    struct mrt_operators *to = s->to;
    const size_t blocks = (size_t)s->level->map->count;
    struct mrt_opening *opening = &to->openings[at];
    memmove(opening + 1, opening, (size_t)(to->opening_count++ - at) * sizeof *opening);
    *opening = (struct mrt_opening){ .block = block, .face = -1 };
    to->clutter_count++;
    opening->pairs = host_alloc(to->host, blocks, sizeof *opening->pairs);
    opening->faces = host_alloc(to->host, (size_t)delta->face_count, sizeof *opening->faces);
    if (!opening->pairs || !opening->faces || !add_face_response(s, delta, opening)) return false;
    const struct mrt_gather_faces *gathered = mrt_kept_gather(s->cache, &s->rays, block);
    bool ok = gathered;
    for (int b = 0; ok && b < (int)blocks; b++) ok = add_face_pair(s, gathered, b, opening);
    for (int i = 0; i < delta->face_count; i++)
        fill_face(s, &s->rays.clutter->faces[delta->first_face + i], i,
                  &opening->faces[opening->face_count++]);
    return ok;
}

// ---- the light map of clutter

// Faces are the first columns of the light of an opening that is clutter.
static bool light_map_of_opening(const struct builder *s,
                                 const struct mrt_clutter_transfer *transfer,
                                 struct mrt_opening *opening)
{
    struct host *host = s->to->host;
    if (opening->face < 0)
        return matrix_f32_copy(host, &transfer->c, (size_t)s->to->k_r, &opening->at_clutter);
    const int shared = mrt_response_of(&s->level->map->blocks[opening->block], opening->face);
    return mrt_clutter_transfer_response(transfer, host, &s->rays, opening->face,
                                         &s->to->responses[shared].u[MRT_PROBE],
                                         &opening->at_clutter);
}

static bool add_rows(struct builder *s, int block, int first_opening, int end)
{
    const struct mrt_clutter_transfer *transfer = mrt_kept_transfer(s->cache, &s->rays, block);
    if (!transfer) return false;
    struct mrt_clutter_rows *rows = &s->to->rows[s->to->row_count++];
    *rows = (struct mrt_clutter_rows){ .block = block,
                                       .first_texel = (int)transfer->first_texel,
                                       .texel_count = (int)transfer->texel_count };
    memcpy(s->inside + transfer->first_texel, transfer->inside,
           transfer->texel_count * sizeof *transfer->inside);
    bool ok = matrix_f32_copy(s->to->host, &transfer->b, transfer->b.columns, &rows->u_b);
    for (int i = first_opening; ok && i < end; i++)
        ok = light_map_of_opening(s, transfer, &s->to->openings[i]);
    return ok;
}

// Texels inside objects have the light of the nearest other one of their chart.
static bool fill_map_source(struct builder *s, bool *hidden, uint32_t *place_of)
{
    const struct mrt_clutter *clutter = s->rays.clutter;
    const struct charts *charts = &clutter->charts;
    for (uint32_t i = 0; i < charts->side_texel_count; i++) {
        place_of[clutter->texels[i]] = i;
        hidden[clutter->texels[i]] = s->inside[i];
    }
    uint32_t *nearest_valid = charts_fill(charts, hidden);
    for (size_t i = 0; nearest_valid && i < charts_place_count(charts); i++) {
        const uint32_t texel = chart_texel_of_place(charts, i);
        s->to->map_source[i] = texel == CHART_NONE ? CHART_NONE : place_of[nearest_valid[texel]];
    }
    const bool ok = nearest_valid;
    host_free(charts->host, nearest_valid);
    return ok;
}

static bool find_map_source(struct builder *s)
{
    const struct charts *charts = &s->rays.clutter->charts;
    struct host *host = s->to->host;
    bool *hidden = host_alloc(host, charts->side_texel_count, sizeof *hidden);
    uint32_t *place_of = host_alloc(host, charts->side_texel_count, sizeof *place_of);
    s->to->map_source = host_alloc(host, charts_place_count(charts), sizeof *s->to->map_source);
    const bool ok = hidden && place_of && s->to->map_source && fill_map_source(s, hidden, place_of);
    host_free(host, hidden);
    host_free(host, place_of);
    return ok;
}

// ---- blocks

static bool add_sight(struct builder *s, int block, const struct mrt_delta_block *delta)
{
    struct mrt_operators *to = s->to;
    const size_t blocks = (size_t)s->level->map->count;
    const size_t edge = to->probes > 0 ? (size_t)mrt_sight_edge(to->probes) : 0;
    const size_t voxels = edge * edge * edge;
    if (!delta->sight) return true;
    if (!to->sight) {
        to->sight = host_alloc(to->host, blocks * (1 + voxels), sizeof *to->sight);
        to->sight_count = blocks;
    }
    if (!to->sight) return false;
    to->sight[block] = (uint32_t)to->sight_count;
    memcpy(to->sight + to->sight_count, delta->sight, voxels * sizeof *delta->sight);
    to->sight_count += voxels;
    return true;
}

// first: the first opening of the block, or of the next one. Writes that of the next block.
static bool add_block(struct builder *s, int block, int *first)
{
    const struct mrt_clutter_changes *changes = s->changes;
    const struct mrt_delta_block *delta = mrt_kept_delta(s->cache, &s->rays, block);
    const bool occludes = delta && delta->touched && changes->occlusion;
    const bool has_faces = delta && delta->face_count > 0;
    bool ok =
        delta && (!occludes || (replace_basis(s, block, delta) && add_sight(s, block, delta)));
    int end = *first;
    for (; ok && end < s->to->opening_count && s->to->openings[end].block == block; end++) {
        struct mrt_opening *opening = &s->to->openings[end];
        ok = (!occludes || replace_response(s, delta, opening)) && change_pairs(s, opening);
    }
    if (ok && has_faces && changes->reflection) ok = add_clutter_opening(s, block, end++, delta);
    if (ok && has_faces && changes->gather) ok = add_rows(s, block, *first, end);
    *first = end;
    return ok;
}

static bool start(struct builder *s)
{
    const struct mrt_operators *to = s->to;
    const size_t blocks = (size_t)s->level->map->count;
    const struct mrt_clutter *clutter = s->rays.clutter;
    s->rays.l_imp = s->l_imp = host_alloc(to->host, blocks, sizeof *s->l_imp);
    s->rays.objects = s->objects = trace_scene_create(to->host, &clutter->objects.pose);
    s->sources = host_alloc(to->host, blocks, sizeof *s->sources);
    s->inside = host_alloc(to->host, clutter->charts.side_texel_count, sizeof *s->inside);
    s->to->rows = host_alloc(to->host, blocks, sizeof *s->to->rows);
    s->rays.t_db = s->t_db = host_alloc(to->host, blocks, sizeof *s->t_db);
    for (size_t b = 0; s->t_db && b < blocks; b++)
        s->t_db[b] = &to->bases[to->basis_of_block[b]].t_db;
    for (size_t b = 0; s->l_imp && b < blocks; b++)
        s->l_imp[b] = &to->bases[to->basis_of_block[b]].l_imp;
    return s->l_imp && s->objects && s->sources && s->inside && s->to->rows;
}

bool mrt_operators_add_clutter(struct mrt_operators *operators, const struct mrt_level *level,
                               const struct mrt_clutter *clutter,
                               const struct mrt_geometry_texel *texels,
                               struct mrt_delta_cache *cache,
                               const struct mrt_clutter_changes *changes)
{
    struct builder s = { .to = operators,
                         .level = level,
                         .texels = texels,
                         .changes = changes,
                         .rays = { .map = level->map,
                                   .resolution = level->resolution,
                                   .clutter = clutter,
                                   .rays = changes->rays,
                                   .probes = operators->probes,
                                   .depth = changes->depth,
                                   .stop = changes->stop },
                         .cache = cache };
    int opening = 0;
    if (!changes->occlusion && !changes->reflection && !changes->gather) return true;
    bool ok = start(&s);
    if (ok) mrt_delta_cache_begin(cache, &s.rays);
    for (int b = 0; ok && b < level->map->count; b++) ok = add_block(&s, b, &opening);
    ok = ok && (!changes->gather || find_map_source(&s)) && mrt_order_faces(operators);
    trace_scene_destroy(s.objects);
    host_free(operators->host, s.l_imp);
    host_free(operators->host, s.t_db);
    host_free(operators->host, s.sources);
    host_free(operators->host, s.inside);
    return ok;
}
