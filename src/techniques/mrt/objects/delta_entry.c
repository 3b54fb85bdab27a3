// Rays from walls through an opening.
#include "techniques/mrt/objects/delta.h"

#include "core/parallel.h"

#include "techniques/mrt/dictionary/gather.h"

// Rays of a texel. All texels of a block make a few coefficients.
enum { ENTRY_RAYS = 256 };

// Segments start and end so much of their way from walls.
static const float OFFSET = 1e-3f;

struct job {
    const struct mrt_clutter_rays *input;
    const struct mrt_entered_opening *opening;
    struct mrt_rays rays;
    struct mrt_shape closed, open; // the entered cube, without and with the opening
    size_t k_b, faces;
    struct matrix_f32 b; // points × sources · k_b: irradiance of walls that are not hidden
    struct matrix_f32 c; // points × all faces
    bool *hidden;        // [points][sources]
};

static int source_of(const struct mrt_entered_opening *input, int block)
{
    for (int i = 0; i < input->source_count; i++)
        if (input->sources[i] == block) return i;
    return -1;
}

static void add_wall(const struct job *job, size_t point, int source, int block, bool hidden,
                     float weight, const struct mrt_hit *wall)
{
    float *to = job->b.at + point * job->b.stride + (size_t)source * job->k_b;
    if (hidden) {
        job->hidden[point * (size_t)job->opening->source_count + (size_t)source] = true;
        return;
    }
    mrt_add_radiosity(wall, weight, job->input->l_imp[block], to);
}

// The first clutter of other blocks on a way.
static bool meets_face(const struct job *job, int block, vec3s from, vec3s to, float weight,
                       size_t point)
{
    const vec3s way = glms_vec3_sub(to, from);
    struct trace_hit hit;
    if (!trace_closest(job->input->objects, glms_vec3_muladds(way, OFFSET, from), way,
                       1.0f - OFFSET, &hit))
        return false;
    const int face = mrt_face_of_hit(job->input->clutter, block, &hit);
    if (face < 0) return true;
    job->c.at[point * job->c.stride + (size_t)face] += weight;
    return true;
}

static void follow(const struct job *job, size_t point, vec3s from, vec3s way, float weight,
                   int block)
{
    const struct mrt_block_map *map = job->input->map;
    bool hidden = false;
    for (int passed = 0; passed <= job->input->depth; passed++) {
        struct mrt_hit wall;
        vec3s end;
        if (block < 0 || !mrt_cell_ray(job->input, block, from, way, &wall, &end)) return;
        const int source = source_of(job->opening, block);
        int face;
        const float share = mrt_passing_share(&map->blocks[block], &wall, &face);
        hidden = hidden || meets_face(job, block, from, end, weight, point);
        if (share < 1.0f && source >= 0)
            add_wall(job, point, source, block, hidden, (1.0f - share) * weight, &wall);
        if (share == 0.0f) return;
        weight *= share;
        block = map->blocks[block].neighbor[face].block;
        from = end;
    }
}

static void trace_point(void *user, size_t i)
{
    const struct job *job = user;
    const struct mrt_block *block = &job->input->map->blocks[job->opening->block];
    const size_t in_face = (size_t)(job->closed.resolution * job->closed.resolution);
    if (i / in_face == (size_t)job->opening->face || mrt_is_stopped(job->input->stop)) return;
    const struct mrt_point point = mrt_shape_texel(&job->closed, (int)i);
    for (int r = 0; r < job->rays.count; r++) {
        const vec3s way = glms_mat3_mulv(point.frame, job->rays.direction[r]);
        struct mrt_hit hit;
        mrt_shape_trace(&job->open, point.position, way, &hit);
        if (hit.opening < 0) continue;
        const float share = mrt_block_is_open(block, job->opening->face)
                                ? 1.0f
                                : mrt_block_hole_at(block, job->opening->face, hit.s, hit.t);
        if (share == 0.0f) continue;
        const vec3s at = glms_vec3_muladds(way, hit.distance, point.position);
        const vec3s world = glms_mat3_mulv(mrt_warp_jacobian(block->corner, at), way);
        follow(job, i, mrt_warp_point(block->corner, at), vec3_unit(world),
               share / (float)job->rays.count, block->neighbor[job->opening->face].block);
    }
}

static bool project(struct host *host, const struct job *job, struct mrt_delta_source *out,
                    int source)
{
    const struct mrt_entered_opening *opening = job->opening;
    int first;
    const int faces = mrt_faces_of_block(job->input->clutter, out->block, &first);
    const struct matrix_f32 b =
        matrix_f32_block(&job->b, 0, (size_t)source * job->k_b, job->b.rows, job->k_b);
    for (size_t p = 0; p < job->b.rows; p++)
        out->hidden =
            out->hidden || job->hidden[p * (size_t)opening->source_count + (size_t)source];
    if (!matrix_f32_init(host, &out->b, opening->u_r->columns, job->k_b) ||
        !matrix_f32_multiply(host, 1.0f, opening->u_r, TRANSPOSED, &b, NOT_TRANSPOSED, 0.0f,
                             &out->b))
        return false;
    if (faces == 0) return true;
    const struct matrix_f32 c =
        matrix_f32_block(&job->c, 0, (size_t)first, job->c.rows, (size_t)faces);
    return matrix_f32_init(host, &out->c, opening->u_r->columns, (size_t)faces) &&
           matrix_f32_multiply(host, 1.0f, opening->u_r, TRANSPOSED, &c, NOT_TRANSPOSED, 0.0f,
                               &out->c);
}

static bool trace_entry(struct mrt_delta_entry *out, struct host *host, struct job *job)
{
    const struct mrt_entered_opening *opening = job->opening;
    const size_t points = opening->u_r->rows, sources = (size_t)opening->source_count;
    job->hidden = host_alloc(host, points * sources, sizeof *job->hidden);
    bool ok = job->hidden && matrix_f32_init(host, &job->b, points, sources * job->k_b) &&
              matrix_f32_init(host, &job->c, points, job->faces) &&
              mrt_rays_init(host, MRT_IRRADIANCE, ENTRY_RAYS, &job->rays);
    if (ok) parallel_for(points, 4, trace_point, job);
    ok = ok && !mrt_is_stopped(job->input->stop);
    for (int i = 0; ok && i < opening->source_count; i++) {
        out->sources[i].block = opening->sources[i];
        ok = project(host, job, &out->sources[i], i);
    }
    mrt_rays_finish(host, &job->rays);
    matrix_f32_finish(host, &job->b);
    matrix_f32_finish(host, &job->c);
    host_free(host, job->hidden);
    return ok;
}

bool mrt_delta_entry_init(struct mrt_delta_entry *out, struct host *host,
                          const struct mrt_clutter_rays *rays,
                          const struct mrt_entered_opening *opening)
{
    struct job job = { .input = rays,
                       .opening = opening,
                       .closed = mrt_cube(rays->resolution, 0),
                       .open = mrt_cube(rays->resolution, 1u << opening->face),
                       .k_b = rays->l_imp[opening->block]->columns,
                       .faces = (size_t)rays->clutter->face_count };
    *out = (struct mrt_delta_entry){ .host = host, .count = opening->source_count };
    out->sources = host_alloc(host, (size_t)opening->source_count, sizeof *out->sources);
    const bool ok = out->sources && trace_entry(out, host, &job);
    if (!ok) mrt_delta_entry_finish(out);
    return ok;
}

void mrt_delta_entry_finish(struct mrt_delta_entry *entry)
{
    for (int i = 0; entry->host && entry->sources && i < entry->count; i++) {
        matrix_f32_finish(entry->host, &entry->sources[i].b);
        matrix_f32_finish(entry->host, &entry->sources[i].c);
    }
    if (entry->host) host_free(entry->host, entry->sources);
    *entry = (struct mrt_delta_entry){ 0 };
}
