// Cosine-distributed rays from the texels of a face through the cells of the blocks.
#include "techniques/mrt/objects/delta.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include "techniques/mrt/dictionary/gather.h"

#include <math.h>

struct job {
    const struct mrt_clutter_rays *input;
    struct mrt_gather_faces *out;
    int block, first_face;
    float *of_b;   // [blocks][faces][k_b]
    bool *reached; // [blocks][faces]
    size_t k_b, faces;
};

static int mean_count(uint32_t texels, int rays)
{
    const int each = (rays + (int)texels - 1) / (int)texels;
    return each < 16 ? 16 : each;
}

static void add_wall(const struct job *job, int block, size_t face, float weight,
                     const struct mrt_hit *hit)
{
    float *to = job->of_b + ((size_t)block * job->faces + face) * job->k_b;
    job->reached[(size_t)block * job->faces + face] = true;
    mrt_add_radiosity(hit, weight, job->input->l_imp[block], to);
}

static void add_face(const struct job *job, size_t face, float weight, const struct trace_hit *hit)
{
    const int column = mrt_face_at(job->input->clutter, hit);
    struct matrix_f32 *of_c = &job->out->of_c;
    if (column >= 0) of_c->at[face * of_c->stride + (size_t)column] += weight;
}

// Adds a ray to the first clutter on it, or to the walls where it ends: to one with holes the share
// that these keep from it.
static void follow(const struct job *job, size_t face, vec3s from, vec3s way, float weight)
{
    const struct mrt_block_map *map = job->input->map;
    struct trace_hit hit;
    const bool blocked = trace_closest(job->input->objects, from, way, INFINITY, &hit);
    vec3s at = from, end;
    int block = job->block;
    for (int passed = 0; block >= 0 && passed <= job->input->depth; passed++, at = end) {
        struct mrt_hit wall;
        int exit;
        if (!mrt_cell_ray(job->input, block, at, way, &wall, &end)) break;
        const float share = mrt_passing_share(&map->blocks[block], &wall, &exit);
        if (blocked && hit.distance <= glms_vec3_distance(from, end)) break;
        if (share < 1.0f) add_wall(job, block, face, (1.0f - share) * weight, &wall);
        if (share == 0.0f) return;
        weight *= share;
        block = map->blocks[block].neighbor[exit].block;
    }
    if (blocked) add_face(job, face, weight, &hit);
}

static void trace_texel(const struct job *job, size_t face, uint32_t of_face, int rays,
                        float weight)
{
    const struct mrt_clutter *clutter = job->input->clutter;
    const struct mrt_clutter_face *of = &clutter->faces[(size_t)job->first_face + face];
    const uint32_t texel = clutter->texels[of->first_texel + of_face];
    // By places in the block, which do not depend on clutter of others.
    const uint32_t seed = pcg_hash(of_face + pcg_hash((uint32_t)face)) | 1u;
    const vec3s normal = chart_texel_normal(&clutter->charts, texel);
    const vec3s position = chart_texel_of(&clutter->charts, texel)->position;
    const vec3s from = glms_vec3_muladds(
        normal, 1e-4f * (1.0f + glms_vec3_max(glms_vec3_abs(position))), position);
    const mat3s frame = mrt_frame_of_normal(normal);
    for (int r = 0; r < rays; r++) {
        const vec2s u = sobol_2d((uint32_t)r, seed);
        const vec3s way = glms_mat3_mulv(frame, sample_hemisphere_cosine(u));
        follow(job, face, from, way, weight);
    }
}

static void trace_face(void *user, size_t face)
{
    const struct job *job = user;
    const struct mrt_clutter *clutter = job->input->clutter;
    const struct mrt_clutter_face *of = &clutter->faces[(size_t)job->first_face + face];
    if (mrt_is_stopped(job->input->stop)) return;
    const int rays = mean_count(of->texel_count, job->input->rays);
    float area = 0.0f;
    for (uint32_t t = 0; t < of->texel_count; t++)
        area += chart_texel_of(&clutter->charts, clutter->texels[of->first_texel + t])->area_m2;
    for (uint32_t t = 0; t < of->texel_count; t++) {
        const uint32_t texel = clutter->texels[of->first_texel + t];
        const float share = chart_texel_of(&clutter->charts, texel)->area_m2 / area;
        trace_texel(job, face, t, rays, share / (float)rays);
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
                           const struct mrt_clutter_rays *rays, int block)
{
    const size_t blocks = (size_t)rays->map->count;
    struct job job = {
        .input = rays, .out = out, .block = block, .k_b = rays->l_imp[block]->columns
    };
    *out = (struct mrt_gather_faces){ .host = host };
    job.faces = (size_t)mrt_faces_of_block(rays->clutter, block, &job.first_face);
    job.of_b = host_alloc(host, blocks * job.faces, job.k_b * sizeof *job.of_b);
    job.reached = host_alloc(host, blocks * job.faces, sizeof *job.reached);
    bool ok = job.of_b && job.reached &&
              matrix_f32_init(host, &out->of_c, job.faces, (size_t)rays->clutter->face_count);
    if (ok) parallel_for(job.faces, 1, trace_face, &job);
    ok = ok && !mrt_is_stopped(rays->stop) && keep_sources(out, &job);
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
