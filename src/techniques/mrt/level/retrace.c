// Rays in the proportions of a block.
//
// An affine warp maps rays of the block to rays of the cube's cell, so that the cube's own lookups
// serve; only the directions, distributed by the cosine at the block's wall, differ.
#include "retrace.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/level/projection.h"

#include <math.h>
#include <string.h>

enum { RAYS = 2048 }; // per texel; the error of U_b is below 1 %
static const float SAME_METRIC = 1e-3f;

static mat3s metric_of(mat3s j)
{
    const mat3s square = glms_mat3_mul(glms_mat3_transpose(j), j);
    const float trace = square.m00 + square.m11 + square.m22;
    return glms_mat3_scale(square, 3.0f / trace);
}

static bool same_metric(mat3s a, mat3s b)
{
    for (int c = 0; c < 3; c++)
        if (glms_vec3_distance(a.col[c], b.col[c]) > SAME_METRIC) return false;
    return true;
}

// ---- gathering

struct gather_job {
    const struct mrt_element *element;
    struct mrt_shape receivers;
    mat3s block_from_cell; // J of the warp
    struct mrt_rays rays;
    struct matrix_f32 *rows; // F of all receivers; NULL: not kept
    struct matrix_f32 *out;
    struct host *hosts; // [receivers]: failures of tasks do not race
    bool *ok;
};

mat3s mrt_cell_from_wall(mat3s block_from_cell, mat3s frame)
{
    const mat3s cell_from_block = glms_mat3_inv(block_from_cell);
    mat3s wall;
    wall.col[2] = vec3_unit(glms_mat3_mulv(glms_mat3_transpose(cell_from_block), frame.col[2]));
    wall.col[0] = vec3_unit(glms_mat3_mulv(block_from_cell, frame.col[0])); // in the wall
    wall.col[1] = glms_vec3_cross(wall.col[2], wall.col[0]);
    return glms_mat3_mul(cell_from_block, wall);
}

static void gather_texel(void *user, size_t i)
{
    struct gather_job *job = user;
    const struct mrt_element *element = job->element;
    const size_t values = (size_t)job->rays.values;
    struct host *host = &job->hosts[i];
    struct mrt_point point = mrt_shape_texel(&job->receivers, (int)i);
    struct matrix_f32 rows = { 0 };
    struct matrix_f32 out = matrix_f32_block(job->out, i * values, 0, values, job->out->columns);
    point.frame = mrt_cell_from_wall(job->block_from_cell, point.frame);
    job->ok[i] = job->rows || matrix_f32_init(host, &rows, values, element->l_imp.rows);
    if (job->rows) rows = matrix_f32_block(job->rows, i * values, 0, values, job->rows->columns);
    if (job->ok[i]) mrt_gather(&element->shape, point, &job->rays, rows.at, rows.stride);
    job->ok[i] = job->ok[i] && matrix_f32_multiply(host, 1.0f, &rows, NOT_TRANSPOSED,
                                                   &element->l_imp, NOT_TRANSPOSED, 0.0f, &out);
    if (!job->rows) matrix_f32_finish(host, &rows);
}

static bool gather(struct host *host, const struct mrt_element *element,
                   const struct mrt_shape *receivers, mat3s block_from_cell,
                   enum mrt_measure measure, struct matrix_f32 *rows, struct matrix_f32 *out)
{
    const size_t texels = (size_t)mrt_shape_texels(receivers);
    struct gather_job job = { .element = element,
                              .receivers = *receivers,
                              .block_from_cell = block_from_cell,
                              .rows = rows,
                              .out = out };
    job.hosts = host_alloc(host, texels, sizeof *job.hosts);
    job.ok = host_alloc(host, texels, sizeof *job.ok);
    bool ok = job.hosts && job.ok && mrt_rays_init(host, measure, RAYS, &job.rays) &&
              matrix_f32_init(host, out, texels * (size_t)job.rays.values, element->l_imp.columns);
    for (size_t i = 0; ok && i < texels; i++) job.hosts[i] = *host;
    if (ok) parallel_for(texels, 8, gather_texel, &job);
    for (size_t i = 0; ok && i < texels; i++) {
        ok = job.ok[i];
        if (!ok) host->failure = job.hosts[i].failure;
    }
    mrt_rays_finish(host, &job.rays);
    host_free(host, job.hosts);
    host_free(host, job.ok);
    return ok;
}

// openings: light that leaves by them counts as that on walls, in the fit.
static bool gather_irradiance(struct host *host, const struct mrt_element *element,
                              mat3s block_from_cell, bool openings, struct mrt_retraced *out)
{
    const struct mrt_shape shape = element->shape;
    const struct mrt_shape receivers = openings ? mrt_cube(shape.resolution, 0) : shape;
    struct matrix_f32 f = { 0 }, u = { 0 };
    const struct mrt_projection projection = { shape, receivers, block_from_cell,
                                               &f,    &u,        &element->l_imp };
    const bool ok =
        matrix_f32_init(host, &f, (size_t)mrt_shape_texels(&receivers), element->l_imp.rows) &&
        gather(host, element, &receivers, block_from_cell, MRT_IRRADIANCE, &f, &u) &&
        (openings ? mrt_rows_of_walls(host, &shape, &u, &out->u_b)
                  : matrix_f32_copy(host, &u, u.columns, &out->u_b)) &&
        matrix_f32_copy(host, &element->t_db, element->t_db.columns, &out->t_db) &&
        mrt_fit_projection(host, &projection, &out->t_db);
    matrix_f32_finish(host, &f);
    matrix_f32_finish(host, &u);
    return ok;
}

// ---- blocks

static int find(const struct mrt_retraces *retraces, int cube, mat3s metric)
{
    for (int i = 0; i < retraces->count; i++)
        if (retraces->at[i].cube == cube && same_metric(retraces->at[i].metric, metric)) return i;
    return -1;
}

static float edge_ratio(mat3s j)
{
    float shortest = INFINITY, longest = 0.0f;
    for (int a = 0; a < 3; a++) {
        const float edge = glms_vec3_norm(j.col[a]);
        shortest = fminf(shortest, edge);
        longest = fmaxf(longest, edge);
    }
    return longest / shortest;
}

static float wall_area(mat3s j)
{
    float area = 0.0f;
    for (int a = 0; a < 3; a++)
        area += 2.0f * glms_vec3_norm(glms_vec3_cross(j.col[a], j.col[(a + 1) % 3]));
    return area;
}

// The index of the block's proportions, which is added if it is new; −1: a cube's, or too flat.
static int add_block(struct mrt_retraces *out, const struct mrt_block *block,
                     const struct mrt_cube_place *place, float flattest)
{
    const mat3s j =
        glms_mat3_mul(mrt_warp_jacobian(block->corner, GLMS_VEC3_ZERO), place->block_from_cube);
    const mat3s metric = metric_of(j);
    if (same_metric(metric, glms_mat3_identity()) || edge_ratio(j) > flattest) return -1;
    int index = find(out, place->cube, metric);
    if (index < 0) {
        index = out->count++;
        out->at[index] =
            (struct mrt_retraced){ .cube = place->cube, .metric = metric, .block_from_cell = j };
    }
    out->at[index].area += wall_area(j);
    return index;
}

static int rank_of(const struct mrt_retraces *out, int index)
{
    int rank = 0;
    for (int i = 0; i < out->count; i++)
        if (out->at[i].area > out->at[index].area ||
            (out->at[i].area == out->at[index].area && i < index))
            rank++;
    return rank;
}

// Leaves the proportions of most area, in their order.
static bool keep_largest(struct mrt_retraces *out, int blocks, int most)
{
    int *to = host_alloc(out->host, (size_t)out->count, sizeof *to), kept = 0;
    if (!to) return false;
    for (int i = 0; i < out->count; i++) to[i] = rank_of(out, i) < most ? kept++ : -1;
    for (int i = 0; i < out->count; i++)
        if (to[i] >= 0) out->at[to[i]] = out->at[i];
    for (int b = 0; b < blocks; b++)
        if (out->of_block[b] >= 0) out->of_block[b] = to[out->of_block[b]];
    out->count = kept;
    host_free(out->host, to);
    return true;
}

static bool retrace(struct host *host, const struct mrt_element *element, bool openings,
                    struct mrt_retraced *to)
{
    return gather_irradiance(host, element, to->block_from_cell, openings, to) &&
           gather(host, element, &element->shape, to->block_from_cell, MRT_VECTOR, NULL,
                  &to->u_vec);
}

bool mrt_retraces_init(struct host *host, const struct mrt_block_map *map,
                       const struct mrt_cube_place *places, const struct mrt_dictionary *dictionary,
                       struct mrt_retrace_limits limits, struct mrt_retraces *out)
{
    const size_t blocks = (size_t)map->count;
    *out = (struct mrt_retraces){ .host = host };
    out->at = host_alloc(host, blocks, sizeof *out->at);
    out->of_block = host_alloc(host, blocks, sizeof *out->of_block);
    bool ok = out->at && out->of_block;
    for (int b = 0; ok && b < map->count; b++)
        out->of_block[b] = add_block(out, &map->blocks[b], &places[b], limits.flattest);
    if (ok && out->count > limits.most) ok = keep_largest(out, map->count, limits.most);
    for (int i = 0; ok && i < out->count; i++)
        ok = retrace(host, &dictionary->element[out->at[i].cube], limits.openings, &out->at[i]);
    if (!ok) mrt_retraces_finish(out);
    return ok;
}

void mrt_retraces_finish(struct mrt_retraces *retraces)
{
    for (int i = 0; i < retraces->count; i++) {
        matrix_f32_finish(retraces->host, &retraces->at[i].u_b);
        matrix_f32_finish(retraces->host, &retraces->at[i].u_vec);
        matrix_f32_finish(retraces->host, &retraces->at[i].t_db);
    }
    if (retraces->host) {
        host_free(retraces->host, retraces->at);
        host_free(retraces->host, retraces->of_block);
    }
    *retraces = (struct mrt_retraces){ 0 };
}
