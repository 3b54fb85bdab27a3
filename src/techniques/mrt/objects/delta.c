// Rays of delta operators.
#include "techniques/mrt/objects/delta.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/level/probes.h"
#include "techniques/mrt/level/projection.h"
#include "techniques/mrt/level/retrace.h"
#include "trace/texels/inside.h"

#include <math.h>
#include <string.h>

enum { POINTS = 64 }; // traced at once

struct job {
    const struct mrt_clutter_cell *cell;
    struct mrt_delta *out;
    struct mrt_rays rays;
    enum mrt_measure measure;
    int first_face;
    size_t first;           // point of this call
    struct matrix_f32 rows; // of its points: light of texels, points · values × n
    bool *touched;          // [points]
    const float *share;     // of rays of each texel that no clutter blocks; NULL: not known
};

// Rays of a point towards an opening, and those that pass.
struct passing {
    float all[CUBE_FACES], kept[CUBE_FACES];
};

// Light of a wall is that of texels that clutter hides less: the rim of a wall behind an object is
// not as bright as the wall behind it.
static void add_wall(const struct job *job, size_t row, const float *weight,
                     const struct mrt_hit *wall)
{
    float share[4], sum = 0.0f;
    for (int k = 0; k < wall->texels; k++) {
        share[k] = wall->weight[k] * (job->share ? job->share[wall->texel[k]] : 1.0f);
        sum += share[k];
    }
    for (int k = 0; k < wall->texels; k++) {
        const float of_texel = sum > 0.0f ? share[k] / sum : wall->weight[k];
        float *to = job->rows.at + row * job->rows.stride + (size_t)wall->texel[k];
        for (int q = 0; q < job->rays.values; q++)
            to[(size_t)q * job->rows.stride] += weight[q] * of_texel;
    }
}

static void add_face(const struct job *job, size_t row, const float *weight, int face)
{
    const int column = face - job->first_face;
    struct matrix_f32 *c = &job->out->c;
    if (column < 0 || column >= (int)c->columns) return;
    for (int q = 0; q < job->rays.values; q++)
        c->at[(row + (size_t)q) * c->stride + (size_t)column] += weight[q];
}

struct blocked {
    int rays, backs; // of all; that meet the back of clutter
};

static void follow(const struct job *job, size_t i, struct mrt_point point, int ray,
                   struct passing *passing, struct blocked *count)
{
    const size_t values = (size_t)job->rays.values;
    const float *weight = job->rays.weight + (size_t)ray * values;
    const vec3s way = vec3_unit(glms_mat3_mulv(point.frame, job->rays.direction[ray]));
    struct mrt_hit wall;
    struct trace_hit hit;
    mrt_shape_trace(&job->cell->shape, point.position, way, &wall);
    const vec3s end = glms_vec3_muladds(way, wall.distance, point.position);
    const bool blocked = mrt_delta_blocked(job->cell, point.position, end, &hit);
    int face;
    const float share = mrt_passing_share(job->cell->block, &wall, &face);
    if (share > 0.0f) {
        passing->all[face] += share * weight[0];
        if (!blocked) passing->kept[face] += share * weight[0];
    }
    if (!blocked) {
        add_wall(job, (i - job->first) * values, weight, &wall);
        return;
    }
    count->rays++;
    // Lookups on a wall beside a double-sided box blend with the texels in it, which are not seen.
    count->backs +=
        job->measure == MRT_PROBE ? mrt_is_inside_at(job->cell->rays->clutter, &hit) : !hit.front;
    job->touched[i] = true;
    add_face(job, i * values, weight,
             mrt_face_of_hit(job->cell->rays->clutter, job->cell->index, &hit));
}

// U_b of a point past clutter.
static void multiply_rows(const struct job *job, size_t i)
{
    const struct matrix_f32 *l_imp = job->cell->rays->l_imp[job->cell->index];
    const size_t values = (size_t)job->rays.values;
    for (size_t q = 0; q < values; q++) {
        const float *from = job->rows.at + ((i - job->first) * values + q) * job->rows.stride;
        float *to = job->out->b.at + (i * values + q) * job->out->b.stride;
        for (size_t t = 0; t < l_imp->rows; t++) {
            const float *light = l_imp->at + t * l_imp->stride;
            if (from[t] == 0.0f) continue;
            for (size_t m = 0; m < l_imp->columns; m++) to[m] += from[t] * light[m];
        }
    }
}

static void trace_point(void *user, size_t in_call)
{
    const struct job *job = user;
    const size_t i = job->first + in_call;
    struct mrt_point point =
        mrt_gather_point(&job->cell->shape, job->cell->rays->probes, job->measure, (int)i);
    struct passing passing = { 0 };
    struct blocked count = { 0 };
    if (mrt_is_stopped(job->cell->rays->stop)) return;
    const mat3s j = mrt_warp_jacobian(job->cell->block->corner, point.position);
    point.frame = job->measure == MRT_PROBE
                      ? glms_mat3_mul(glms_mat3_inv(j), mrt_block_rotation(job->cell->block))
                      : mrt_cell_from_wall(j, point.frame);
    for (int r = 0; r < job->rays.count; r++) follow(job, i, point, r, &passing, &count);
    multiply_rows(job, i);
    job->out->inside[i] = is_inside(count.backs, job->rays.count);
    job->out->open[i] = (float)(job->rays.count - count.rays) / (float)job->rays.count;
    for (int f = 0; f < CUBE_FACES; f++)
        job->out->kept[i][f] = passing.all[f] > 0.0f       ? passing.kept[f] / passing.all[f]
                               : job->out->open[i] == 0.0f ? 0.0f
                                                           : 1.0f;
}

// T_d→b past clutter, from F.
static bool project(struct mrt_delta_block *out, const struct mrt_clutter_cell *cell,
                    const struct matrix_f32 *f)
{
    const struct mrt_delta *of = &out->of[MRT_IRRADIANCE];
    const struct matrix_f32 *l_imp = cell->rays->l_imp[cell->index];
    const struct matrix_f32 *t_db = cell->rays->t_db[cell->index];
    const mat3s middle = mrt_warp_jacobian(cell->block->corner, glms_vec3_zero());
    const struct mrt_projection projection = { cell->shape, cell->shape, middle, f, &of->b, l_imp };
    return matrix_f32_copy(out->host, t_db, t_db->columns, &out->t_db) &&
           mrt_weigh_projection(out->host, l_imp, of->open, &out->t_db) &&
           mrt_fit_projection(out->host, &projection, &out->t_db);
}

// F is kept until it is projected, other measures until they are multiplied.
static bool trace_points(struct job *job, struct mrt_delta_block *out, size_t points)
{
    const size_t n = (size_t)mrt_shape_texels(&job->cell->shape);
    const bool all = job->measure == MRT_IRRADIANCE;
    const size_t at_once = all ? points : POINTS;
    bool ok = matrix_f32_init(out->host, &job->rows, at_once * (size_t)job->rays.values, n);
    for (job->first = 0; ok && job->first < points; job->first += at_once) {
        const size_t rest = points - job->first;
        memset(job->rows.at, 0, job->rows.rows * n * sizeof *job->rows.at);
        parallel_for(rest < at_once ? rest : at_once, 4, trace_point, job);
    }
    ok = ok && !mrt_is_stopped(job->cell->rays->stop) &&
         (!all || project(out, job->cell, &job->rows));
    matrix_f32_finish(out->host, &job->rows);
    return ok;
}

static bool trace_measure(struct mrt_delta_block *out, const struct mrt_clutter_cell *cell,
                          enum mrt_measure measure)
{
    const struct mrt_clutter_rays *rays = cell->rays;
    const size_t points = (size_t)(measure == MRT_PROBE ? mrt_probes_of_block(rays->probes)
                                                        : mrt_shape_texels(&cell->shape));
    struct host *host = out->host;
    struct mrt_delta *delta = &out->of[measure];
    struct job job = {
        .cell = cell, .out = delta, .measure = measure, .first_face = out->first_face
    };
    if (measure == MRT_IRRADIANCE) job.share = out->of[MRT_VECTOR].open;
    bool ok = mrt_rays_init(host, measure, rays->rays, &job.rays);
    const size_t rows = ok ? points * (size_t)job.rays.values : 0;
    job.touched = host_alloc(host, points, sizeof *job.touched);
    delta->inside = host_alloc(host, points, sizeof *delta->inside);
    delta->open = host_alloc(host, points, sizeof *delta->open);
    delta->kept = host_alloc(host, points, sizeof *delta->kept);
    ok = ok && delta->kept && job.touched && delta->inside && delta->open &&
         matrix_f32_init(host, &delta->b, rows, rays->l_imp[cell->index]->columns) &&
         matrix_f32_init(host, &delta->c, rows, (size_t)out->face_count);
    ok = ok && trace_points(&job, out, points);
    for (size_t i = 0; ok && i < points; i++) out->touched = out->touched || job.touched[i];
    host_free(host, job.touched);
    mrt_rays_finish(host, &job.rays);
    return ok;
}

int mrt_faces_of_block(const struct mrt_clutter *clutter, int block, int *first)
{
    int count = 0;
    *first = 0;
    for (int f = 0; f < clutter->face_count; f++) {
        if (clutter->faces[f].block != block) continue;
        if (count++ == 0) *first = f;
    }
    return count;
}

static bool find_sight(struct mrt_delta_block *out, const struct mrt_clutter_cell *cell)
{
    const size_t edge = (size_t)mrt_sight_edge(cell->rays->probes);
    out->sight = host_alloc(out->host, edge * edge * edge, sizeof *out->sight);
    if (out->sight) mrt_probe_sight(cell, out->sight);
    return out->sight && !mrt_is_stopped(cell->rays->stop);
}

bool mrt_delta_block_init(struct mrt_delta_block *out, struct host *host,
                          const struct mrt_clutter_rays *rays, int block)
{
    const struct mrt_clutter_cell cell = mrt_clutter_cell_of(rays, block);
    *out = (struct mrt_delta_block){ .host = host };
    out->face_count = mrt_faces_of_block(rays->clutter, block, &out->first_face);
    if (box3_is_empty(cell.bounds)) return true;
    const bool ok =
        trace_measure(out, &cell, MRT_VECTOR) && trace_measure(out, &cell, MRT_IRRADIANCE) &&
        (rays->probes == 0 || (trace_measure(out, &cell, MRT_PROBE) && find_sight(out, &cell)));
    if (!ok) mrt_delta_block_finish(out);
    return ok;
}

void mrt_delta_block_finish(struct mrt_delta_block *delta)
{
    for (int m = 0; delta->host && m < MRT_MEASURES; m++) {
        matrix_f32_finish(delta->host, &delta->of[m].b);
        matrix_f32_finish(delta->host, &delta->of[m].c);
        host_free(delta->host, delta->of[m].inside);
        host_free(delta->host, delta->of[m].open);
        host_free(delta->host, delta->of[m].kept);
    }
    if (delta->host) matrix_f32_finish(delta->host, &delta->t_db);
    if (delta->host) host_free(delta->host, delta->sight);
    *delta = (struct mrt_delta_block){ 0 };
}
