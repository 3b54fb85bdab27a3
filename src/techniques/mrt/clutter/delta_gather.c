// Cosine-distributed rays from the texels of a face through the cells of the blocks.
#include "techniques/mrt/clutter/delta_gather.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

struct job {
    const struct mrt_gather_input *input;
    struct mrt_gather_faces *out;
    int first_face;
    float *of_b;   // [blocks][faces][k_b]
    bool *reached; // [blocks][faces]
    size_t k_b, faces;
};

struct ray {
    int block;
    vec3s position, direction; // in the cell
};

static int mean_count(uint32_t texels, int rays)
{
    const int each = (rays + (int)texels - 1) / (int)texels;
    return each < 16 ? 16 : each;
}

// The ray in the cell of a block. False where the warp has no inverse there.
static bool enter(const struct mrt_block_map *map, int block, vec3s from, vec3s way,
                  struct ray *ray)
{
    const vec3s *corner = map->blocks[block].corner;
    ray->block = block;
    if (!mrt_warp_inverse(corner, from, &ray->position)) return false;
    ray->position = glms_vec3_maxv(glms_vec3_minv(ray->position, vec3_of(0.5f, 0.5f, 0.5f)),
                                   vec3_of(-0.5f, -0.5f, -0.5f));
    const mat3s cell_from_world = glms_mat3_inv(mrt_warp_jacobian(corner, ray->position));
    ray->direction = vec3_unit(glms_mat3_mulv(cell_from_world, way));
    return glms_vec3_norm2(ray->direction) > 0.0f;
}

static void add_wall(const struct job *job, int block, size_t face, float weight,
                     const struct mrt_hit *hit)
{
    const struct matrix_f32 *l_imp = job->input->l_imp[block];
    float *to = job->of_b + ((size_t)block * job->faces + face) * job->k_b;
    job->reached[(size_t)block * job->faces + face] = true;
    for (int k = 0; k < hit->texels; k++) {
        const float *from = l_imp->at + (size_t)hit->texel[k] * l_imp->stride;
        for (size_t m = 0; m < job->k_b; m++) to[m] += weight * hit->weight[k] * from[m];
    }
}

// Follows a ray that no clutter blocks through openings to a wall.
static void follow(const struct job *job, struct ray ray, vec3s way, size_t face, float weight)
{
    const struct mrt_block_map *map = job->input->map;
    for (int passed = 0; passed <= job->input->depth; passed++) {
        const struct mrt_block *block = &map->blocks[ray.block];
        const struct mrt_shape shape = mrt_block_shape(block, job->input->resolution);
        struct mrt_hit hit;
        mrt_shape_trace(&shape, ray.position, ray.direction, &hit);
        if (hit.opening < 0) {
            add_wall(job, ray.block, face, weight, &hit);
            return;
        }
        const int next = block->neighbor[hit.opening].block;
        const vec3s at = glms_vec3_muladds(ray.direction, hit.distance, ray.position);
        if (next < 0 || !enter(map, next, mrt_warp_point(block->corner, at), way, &ray)) return;
    }
}

static vec3s turned_to(vec3s normal, vec3s local)
{
    vec3s u, v;
    basis_of(normal, &u, &v);
    return glms_vec3_add(glms_vec3_muladds(u, local.x, glms_vec3_scale(v, local.y)),
                         glms_vec3_scale(normal, local.z));
}

static void add_face(const struct job *job, size_t face, float weight, const struct trace_hit *hit)
{
    const int column = mrt_face_of_hit(job->input->clutter, hit) - job->first_face;
    if (column < 0 || column >= (int)job->faces) return;
    struct matrix_f32 *of_c = &job->out->of_c;
    of_c->at[face * of_c->stride + (size_t)column] += weight;
}

// How far a ray goes before it meets a wall of its block: clutter beyond that does not block it.
static float way_in_block(const struct job *job, const struct ray *ray, vec3s from)
{
    const struct mrt_block *block = &job->input->map->blocks[ray->block];
    const struct mrt_shape shape = mrt_block_shape(block, job->input->resolution);
    struct mrt_hit hit;
    mrt_shape_trace(&shape, ray->position, ray->direction, &hit);
    if (hit.opening >= 0) return INFINITY;
    const vec3s end = glms_vec3_muladds(ray->direction, hit.distance, ray->position);
    return glms_vec3_distance(from, mrt_warp_point(block->corner, end));
}

static void trace_texel(const struct job *job, size_t face, uint32_t texel, int rays, float weight)
{
    const struct mrt_clutter *clutter = job->input->clutter;
    const struct mrt_clutter_face *of = &clutter->faces[(size_t)job->first_face + face];
    const vec3s normal = chart_texel_normal(&clutter->charts, texel);
    const vec3s position = clutter->charts.texels[texel].position;
    const vec3s from = glms_vec3_muladds(
        normal, 1e-4f * (1.0f + glms_vec3_max(glms_vec3_abs(position))), position);
    for (int r = 0; r < rays; r++) {
        const vec2s u = sobol_2d((uint32_t)r, pcg_hash(texel) | 1u);
        const vec3s way = turned_to(normal, sample_hemisphere_cosine(u));
        struct trace_hit hit;
        struct ray ray;
        const bool enters = enter(job->input->map, of->block, from, way, &ray);
        const float most = enters ? way_in_block(job, &ray, from) : INFINITY;
        if (trace_closest(job->input->objects, from, way, most, &hit))
            add_face(job, face, weight, &hit);
        else if (enters)
            follow(job, ray, way, face, weight);
    }
}

static void trace_face(void *user, size_t face)
{
    const struct job *job = user;
    const struct mrt_clutter *clutter = job->input->clutter;
    const struct mrt_clutter_face *of = &clutter->faces[(size_t)job->first_face + face];
    const int rays = mean_count(of->texel_count, job->input->rays);
    float area = 0.0f;
    for (uint32_t t = 0; t < of->texel_count; t++)
        area += clutter->charts.texels[clutter->texels[of->first_texel + t]].area_m2;
    for (uint32_t t = 0; t < of->texel_count; t++) {
        const uint32_t texel = clutter->texels[of->first_texel + t];
        const float share = clutter->charts.texels[texel].area_m2 / area;
        trace_texel(job, face, texel, rays, share / (float)rays);
    }
}

static bool is_reached(const struct job *job, int block)
{
    for (size_t f = 0; f < job->faces; f++)
        if (job->reached[(size_t)block * job->faces + f]) return true;
    return false;
}

static bool keep_sources(struct mrt_gather_faces *out, const struct job *job)
{
    const int blocks = job->input->map->count;
    out->from = host_alloc(out->host, (size_t)blocks, sizeof *out->from);
    if (!out->from) return false;
    for (int b = 0; b < blocks; b++) {
        if (!is_reached(job, b)) continue;
        struct mrt_gathered *to = &out->from[out->count++];
        to->source = b;
        if (!matrix_f32_init(out->host, &to->of_b, job->faces, job->k_b)) return false;
        for (size_t i = 0; i < job->faces * job->k_b; i++)
            to->of_b.at[i / job->k_b * to->of_b.stride + i % job->k_b] =
                job->of_b[(size_t)b * job->faces * job->k_b + i];
    }
    return true;
}

bool mrt_gather_faces_init(struct mrt_gather_faces *out, struct host *host,
                           const struct mrt_gather_input *input, int block)
{
    const size_t blocks = (size_t)input->map->count;
    struct job job = { .input = input, .out = out, .k_b = input->l_imp[block]->columns };
    *out = (struct mrt_gather_faces){ .host = host };
    job.faces = (size_t)mrt_faces_of_block(input->clutter, block, &job.first_face);
    job.of_b = host_alloc(host, blocks * job.faces, job.k_b * sizeof *job.of_b);
    job.reached = host_alloc(host, blocks * job.faces, sizeof *job.reached);
    bool ok = job.of_b && job.reached && matrix_f32_init(host, &out->of_c, job.faces, job.faces);
    if (ok) parallel_for(job.faces, 1, trace_face, &job);
    ok = ok && keep_sources(out, &job);
    host_free(host, job.of_b);
    host_free(host, job.reached);
    if (!ok) mrt_gather_faces_finish(out);
    return ok;
}

void mrt_gather_faces_finish(struct mrt_gather_faces *gather)
{
    if (!gather->host) return;
    for (int i = 0; i < gather->count; i++) matrix_f32_finish(gather->host, &gather->from[i].of_b);
    host_free(gather->host, gather->from);
    matrix_f32_finish(gather->host, &gather->of_c);
    *gather = (struct mrt_gather_faces){ 0 };
}
