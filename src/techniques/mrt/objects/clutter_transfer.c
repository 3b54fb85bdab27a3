// Rays from the texels of clutter through the cell of their block.
#include "techniques/mrt/objects/delta.h"

#include "core/parallel.h"
#include "core/sh.h"

#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/level/probes.h"
#include "trace/texels/inside.h"

#include <math.h>

enum { VALUES = MRT_VECTOR_COEFFICIENTS };

static const float Y0 = 0.28209479f, Y1 = 0.48860251f, Y2 = 0.63078313f; // at the pole, by band

struct job {
    const struct mrt_clutter_rays *input;
    struct mrt_clutter_transfer *out;
    int first_face;
    struct mrt_rays rays;
};

// ---- values

// The constant term such that the value at the pole is `at_pole`.
static void set_at_pole(float value[VALUES], float at_pole)
{
    value[0] = (at_pole - Y1 * value[2]) / Y0;
}

// Linear terms, in the order y, z, x, turn as a vector.
static void turn(mat3s world_from_local, float value[VALUES])
{
    const vec3s v = glms_mat3_mulv(world_from_local, vec3_of(value[3], value[1], value[2]));
    value[1] = v.y;
    value[2] = v.z;
    value[3] = v.x;
}

// ---- rays

struct texel_job {
    const struct job *job;
    size_t index;
    vec3s from;
    mat3s frame;
    float all[CUBE_FACES], kept[CUBE_FACES]; // of rays to the openings
    int backs;
};

static void add_wall(const struct texel_job *t, const float weight[VALUES],
                     const struct mrt_hit *wall)
{
    const struct matrix_f32 *b = &t->job->out->b;
    for (int q = 0; q < VALUES; q++)
        mrt_add_radiosity(wall, weight[q], t->job->input->l_imp[t->job->out->block],
                          b->at + (t->index * VALUES + (size_t)q) * b->stride);
}

static void add_face(struct texel_job *t, const float weight[VALUES], const struct trace_hit *hit)
{
    const int column =
        mrt_face_of_hit(t->job->input->clutter, t->job->out->block, hit) - t->job->first_face;
    struct matrix_f32 *c = &t->job->out->c;
    t->backs += mrt_is_inside_at(t->job->input->clutter, hit);
    if (column < 0 || column >= (int)c->columns) return;
    for (int q = 0; q < VALUES; q++)
        c->at[(t->index * VALUES + (size_t)q) * c->stride + (size_t)column] += weight[q];
}

static void follow(struct texel_job *t, int r)
{
    const struct mrt_clutter_rays *input = t->job->input;
    const vec3s local = t->job->rays.direction[r], way = glms_mat3_mulv(t->frame, local);
    const float cosine = 2.0f * local.z / (float)t->job->rays.count; // of uniform rays
    float weight[VALUES];
    struct mrt_hit wall;
    struct trace_hit hit;
    for (int q = 0; q < VALUES; q++) weight[q] = t->job->rays.weight[r * VALUES + q];
    set_at_pole(weight, cosine);
    turn(t->frame, weight);
    vec3s end;
    if (!mrt_cell_ray(input, t->job->out->block, t->from, way, &wall, &end)) return;
    const bool blocked =
        trace_closest(input->objects, t->from, way, glms_vec3_distance(t->from, end), &hit);
    int face;
    const float share = mrt_passing_share(&input->map->blocks[t->job->out->block], &wall, &face);
    if (share > 0.0f) {
        t->all[face] += share * cosine;
        if (!blocked) t->kept[face] += share * cosine;
    }
    if (blocked)
        add_face(t, weight, &hit);
    else if (wall.opening < 0)
        add_wall(t, weight, &wall);
}

static uint32_t own_texel(const struct mrt_clutter_rays *input,
                          const struct mrt_clutter_transfer *transfer, size_t i)
{
    return input->clutter->texels[transfer->first_texel + i];
}

static void trace_texel(void *user, size_t i)
{
    const struct job *job = user;
    const struct charts *charts = &job->input->clutter->charts;
    const uint32_t texel = own_texel(job->input, job->out, i);
    if (mrt_is_stopped(job->input->stop)) return;
    const vec3s normal = chart_texel_normal(charts, texel);
    const vec3s position = chart_texel_of(charts, texel)->position;
    const float away = 1e-4f * (1.0f + glms_vec3_max(glms_vec3_abs(position)));
    struct texel_job t = { .job = job,
                           .index = i,
                           .from = glms_vec3_muladds(normal, away, position),
                           .frame = mrt_frame_of_normal(normal) };
    for (int r = 0; r < job->rays.count; r++) follow(&t, r);
    job->out->inside[i] = is_inside(t.backs, job->rays.count);
    for (int f = 0; f < CUBE_FACES; f++)
        job->out->kept[i][f] = t.all[f] > 0.0f ? t.kept[f] / t.all[f] : 0.0f;
}

bool mrt_clutter_transfer_init(struct mrt_clutter_transfer *out, struct host *host,
                               const struct mrt_clutter_rays *rays, int block)
{
    struct job job = { .input = rays, .out = out };
    const int faces = mrt_faces_of_block(rays->clutter, block, &job.first_face);
    *out = (struct mrt_clutter_transfer){ .host = host, .block = block };
    if (faces > 0) {
        const struct mrt_clutter *clutter = rays->clutter;
        const struct mrt_clutter_face *first = &clutter->faces[job.first_face],
                                      *end = first + faces;
        out->first_texel = first->first_texel;
        out->texel_count =
            (end < clutter->faces + clutter->face_count ? end->first_texel
                                                        : clutter->charts.side_texel_count) -
            first->first_texel;
    }
    out->inside = host_alloc(host, out->texel_count, sizeof *out->inside);
    out->kept = host_alloc(host, out->texel_count, sizeof *out->kept);
    bool ok =
        out->inside && out->kept &&
        matrix_f32_init(host, &out->b, out->texel_count * VALUES, rays->l_imp[block]->columns) &&
        matrix_f32_init(host, &out->c, out->texel_count * VALUES, (size_t)faces) &&
        mrt_rays_init(host, MRT_VECTOR, rays->rays, &job.rays);
    if (ok) parallel_for(out->texel_count, 4, trace_texel, &job);
    ok = ok && !mrt_is_stopped(rays->stop);
    mrt_rays_finish(host, &job.rays);
    if (!ok) mrt_clutter_transfer_finish(out);
    return ok;
}

void mrt_clutter_transfer_finish(struct mrt_clutter_transfer *transfer)
{
    if (!transfer->host) return;
    matrix_f32_finish(transfer->host, &transfer->b);
    matrix_f32_finish(transfer->host, &transfer->c);
    host_free(transfer->host, transfer->kept);
    host_free(transfer->host, transfer->inside);
    *transfer = (struct mrt_clutter_transfer){ 0 };
}

// ---- light of openings

enum { CORNERS = 8 };

// The probes around a point, with trilinear weights; beyond the outer ones, these.
static void probes_around(int p, vec3s cell, int index[CORNERS], float weight[CORNERS])
{
    int low[3];
    float t[3];
    for (int a = 0; a < 3; a++) {
        const float at = (cell.raw[a] + 0.5f) * (float)p - 0.5f;
        const float inside = fminf(fmaxf(at, 0.0f), (float)(p - 1));
        low[a] = (int)fminf(inside, (float)(p > 1 ? p - 2 : 0));
        t[a] = inside - (float)low[a];
    }
    for (int c = 0; c < CORNERS; c++) {
        int place[3];
        weight[c] = 1.0f;
        for (int a = 0; a < 3; a++) {
            const int high = c >> a & 1;
            place[a] = low[a] + (p > 1 ? high : 0);
            weight[c] *= high ? t[a] : 1.0f - t[a];
        }
        index[c] = (place[2] * p + place[1]) * p + place[0];
    }
}

struct response_job {
    const struct mrt_clutter_rays *input;
    const struct mrt_clutter_transfer *transfer;
    const struct matrix_f32 *probes;
    int face, p;
    mat3s world_from_cell;
    struct matrix_f32 *out;
};

// As values of the texel, of irradiance by normal in its frame.
static void fit(const float sh[MRT_PROBE_COEFFICIENTS], mat3s frame, float value[VALUES])
{
    mrt_ohlsh_from_sh9(sh, value);
    set_at_pole(value, Y0 * sh[0] + Y1 * sh[2] + Y2 * sh[6]);
    turn(frame, value);
}

static void interpolate(const struct response_job *job, const int index[CORNERS],
                        const float weight[CORNERS], size_t column,
                        float sh[MRT_PROBE_COEFFICIENTS])
{
    for (size_t k = 0; k < MRT_PROBE_COEFFICIENTS; k++) {
        sh[k] = 0.0f;
        for (int c = 0; c < CORNERS; c++) {
            const size_t row = (size_t)index[c] * MRT_PROBE_COEFFICIENTS + k;
            sh[k] += weight[c] * job->probes->at[row * job->probes->stride + column];
        }
    }
}

static void respond(void *user, size_t i)
{
    const struct response_job *job = user;
    const struct charts *charts = &job->input->clutter->charts;
    const uint32_t texel = own_texel(job->input, job->transfer, i);
    const mat3s frame = mrt_frame_of_normal(chart_texel_normal(charts, texel));
    const mat3s local_from_cell = glms_mat3_mul(glms_mat3_transpose(frame), job->world_from_cell);
    int index[CORNERS];
    float weight[CORNERS];
    vec3s cell;
    if (!mrt_cell_of_point(job->input->map, job->transfer->block,
                           chart_texel_of(charts, texel)->position, &cell))
        return;
    probes_around(job->p, cell, index, weight);
    for (size_t m = 0; m < job->out->columns; m++) {
        float sh[MRT_PROBE_COEFFICIENTS], rotated[MRT_PROBE_COEFFICIENTS], value[VALUES];
        interpolate(job, index, weight, m, sh);
        sh_rotate(3, local_from_cell, sh, rotated);
        fit(rotated, frame, value);
        for (size_t q = 0; q < VALUES; q++)
            job->out->at[(i * VALUES + q) * job->out->stride + m] =
                job->transfer->kept[i][job->face] * value[q];
    }
}

bool mrt_clutter_transfer_response(const struct mrt_clutter_transfer *transfer, struct host *host,
                                   const struct mrt_clutter_rays *rays, int face,
                                   const struct matrix_f32 *probes, struct matrix_f32 *out)
{
    const struct response_job job = {
        .input = rays,
        .transfer = transfer,
        .probes = probes,
        .face = face,
        .p = rays->probes,
        .world_from_cell = mrt_block_rotation(&rays->map->blocks[transfer->block]),
        .out = out,
    };
    if (!matrix_f32_init(host, out, transfer->texel_count * VALUES, probes->columns)) return false;
    if (probes->rows > 0) parallel_for(transfer->texel_count, 16, respond, (void *)&job);
    return true;
}
