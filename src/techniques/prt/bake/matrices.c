// The stage of the third wave, with `glossy`: transfer matrices (Sloan, Kautz & Snyder 2002; Hong
// 2015, section 2.5.1.4). Row k of a texel's matrix is a transfer vector: coefficient k of the
// radiance that its specular lobe reflects, in the frame of its normal (basis_of), by the
// coefficients of distant light in the world.
#include "techniques/prt/bake/lobes.h"
#include "techniques/prt/bake/sent.h"

#include "bake/plan.h"
#include "core/half.h"
#include "core/rng.h"
#include "trace/surface.h"

#include <math.h>
#include <string.h>

enum { TEXELS_PER_TASK = 64 };
enum { OUT_MATRIX, OUT_NORMAL, OUT_ROUGHNESS, OUT_COUNT };

struct work {
    const struct prt_scene *scene;
    const struct bake_task *task;
    size_t texels, coefficients, planes, rays;
    const float *point;
    struct prt_sent sent; // with bounces
    float *basis;         // [rays][coefficients] Y_i of the lobes' directions
    float *rows;          // [PRT_OUTGOING][rays] of the texel's lobe
    float *radiance; // [rays][coefficients][planes] that arrives, in the frame of the texel; of
                     // bounces in that of the world
};

// ---- memory

static bool work_init(struct work *w, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *point = bake_task_input(task, LIGHT_MAP_POINT);
    *w = (struct work){ .scene = scene,
                        .task = task,
                        .texels = scene->charts.side_texel_count,
                        .coefficients = prt_coefficients(&scene->options),
                        .planes = prt_has_bounces(&scene->options) ? 4 : 1,
                        .rays = scene->lobes.rays };
    if (!point) return false;
    w->point = point->data;
    w->basis = host_alloc(task->host, w->rays, w->coefficients * sizeof *w->basis);
    w->rows = host_alloc(task->host, w->rays, PRT_OUTGOING * sizeof *w->rows);
    w->radiance =
        host_alloc(task->host, w->rays, w->coefficients * w->planes * sizeof *w->radiance);
    if (!w->basis || !w->rows || !w->radiance) return false;
    for (size_t s = 0; s < w->rays; s++)
        sh_eval(prt_bands(&scene->options), scene->lobes.direction[s],
                w->basis + s * w->coefficients);
    return !prt_has_bounces(&scene->options) || prt_sent_init(&w->sent, task);
}

static void work_finish(struct work *w)
{
    prt_sent_finish(&w->sent);
    host_free(w->task->host, w->basis);
    host_free(w->task->host, w->rows);
    host_free(w->task->host, w->radiance);
}

// ---- a texel

struct frame {
    vec3s position, geometric; // offset against self-intersection; unit
    vec3s normal;              // mean shading normal, unit
    float turn;                // of the rays about it, by which texels differ
    mat3s to_world;            // of the rays
    float roughness;
};

static mat3s rotation_about_z(float angle)
{
    const float c = cosf(angle), s = sinf(angle);
    return (mat3s){ .col = { { { c, s, 0 } }, { { -s, c, 0 } }, { { 0, 0, 1 } } } };
}

static struct frame frame_of(const struct work *w, uint32_t texel)
{
    const struct prt_scene *scene = w->scene;
    const struct chart_texel *t = chart_texel_of(&scene->charts, texel);
    const struct chart_triangle *of = chart_triangle_of(&scene->charts, texel);
    const float *point = w->point + 4 * (size_t)texel;
    const float reach = trace_mesh_of(scene->trace, of->instance)->facets[of->triangle].reach;
    struct frame out = { .geometric = chart_texel_normal(&scene->charts, texel) };
    struct surface surface;
    vec3s normal, tangent, bitangent;
    texel_surface(scene->trace, of, t->u, t->v, out.geometric, &surface);
    texel_reflectance(scene->trace, &scene->charts, texel, &normal);
    normal = glms_vec3_norm(normal) > 0.0f ? glms_vec3_normalize(normal) : out.geometric;
    basis_of(normal, &tangent, &bitangent);
    out.position = glms_vec3_muladds(out.geometric, reach, vec3_of(point[0], point[1], point[2]));
    out.roughness = surface.material.roughness;
    out.normal = normal;
    out.turn = 2.0f * GLM_PIf * rng_unit((uint32_t)(rng_mix(w->task->bake_seed + texel) >> 32));
    const mat3s frame = { .col = { tangent, bitangent, normal } };
    out.to_world = glms_mat3_mul(frame, rotation_about_z(out.turn));
    return out;
}

// Radiance along ray s by coefficients: of the visible sky, or sent by a texel.
static void trace(const struct work *w, const struct frame *frame, size_t s)
{
    const struct prt_scene *scene = w->scene;
    float *out = w->radiance + s * w->coefficients * w->planes;
    vec3s direction = glms_mat3_mulv(frame->to_world, scene->lobes.direction[s]);
    // Directions below the surface, by shading normals, are mirrored at it.
    const float below = glms_vec3_dot(direction, frame->geometric);
    if (below < 0.0f) direction = glms_vec3_muladds(frame->geometric, -2.0f * below, direction);
    const struct ray ray = { frame->position, direction, 0.0f, INFINITY };
    struct ray_hit hit;
    memset(out, 0, w->coefficients * w->planes * sizeof *out);
    if (scene->options.transfer == PRT_UNSHADOWED ||
        !embree_closest(scene->trace->embree, &ray, NULL, false, &hit)) {
        for (size_t i = 0; i < w->coefficients; i++)
            out[i * w->planes] = w->basis[s * w->coefficients + i];
        return;
    }
    if (!prt_has_bounces(&scene->options)) return;
    const struct texel_hit at_hit = texel_hit_at(scene->trace, &ray, &hit);
    const uint32_t texel = prt_sent_receiver(scene, &hit, &at_hit, 0.0f);
    if (texel != CHART_NONE) prt_sent_radiance(&w->sent, texel, out);
}

// Σ_s rows[k][s] radiance[s].
static void reflect(const struct work *w, float *matrix)
{
    const size_t width = w->coefficients * w->planes;
    memset(matrix, 0, PRT_OUTGOING * width * sizeof *matrix);
    for (size_t s = 0; s < w->rays; s++) {
        const float *radiance = w->radiance + s * width;
        for (size_t k = 0; k < PRT_OUTGOING; k++) {
            const float weight = w->rows[k * w->rays + s];
            for (size_t i = 0; i < width; i++) matrix[k * width + i] += weight * radiance[i];
        }
    }
}

// Columns of the visible sky, from the frame of the rays to the world, and rows, to the frame of
// the normal.
static void rotate(const struct work *w, const struct frame *frame, float *matrix)
{
    const size_t width = w->coefficients * w->planes;
    struct sh_rotation light, outgoing;
    float in[SH_MAX_COUNT], out[SH_MAX_COUNT];
    sh_rotation_init(&light, prt_bands(&w->scene->options), frame->to_world);
    sh_rotation_init(&outgoing, PRT_OUTGOING_BANDS, rotation_about_z(frame->turn));
    for (size_t k = 0; k < PRT_OUTGOING; k++) {
        float *row = matrix + k * width;
        for (size_t i = 0; i < w->coefficients; i++) in[i] = row[i * w->planes];
        sh_rotation_apply(&light, in, out);
        for (size_t i = 0; i < w->coefficients; i++) row[i * w->planes] = out[i];
    }
    for (size_t i = 0; i < width; i++) {
        for (size_t k = 0; k < PRT_OUTGOING; k++) in[k] = matrix[k * width + i];
        sh_rotation_apply(&outgoing, in, out);
        for (size_t k = 0; k < PRT_OUTGOING; k++) matrix[k * width + i] = out[k];
    }
}

static void make_matrix(const struct work *w, uint32_t texel, uint64_t row)
{
    const size_t count = PRT_OUTGOING * w->coefficients * w->planes;
    float matrix[PRT_OUTGOING * PRT_MAX_COEFFICIENTS * 4];
    uint16_t *out = bake_row(w->task, OUT_MATRIX, row);
    if (!(w->point[4 * (size_t)texel + 3] > 0.0f)) return;
    const struct frame frame = frame_of(w, texel);
    for (size_t s = 0; s < w->rays; s++) trace(w, &frame, s);
    prt_lobes_at(&w->scene->lobes, frame.roughness, w->rows);
    reflect(w, matrix);
    rotate(w, &frame, matrix);
    for (size_t i = 0; i < count; i++) out[i] = half_from_float(matrix[i]);
    memcpy(bake_row(w->task, OUT_NORMAL, row), frame.normal.raw, sizeof frame.normal.raw);
    *(float *)bake_row(w->task, OUT_ROUGHNESS, row) = frame.roughness;
}

static bool run(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    uint64_t count, first = bake_task_rows(task, OUT_MATRIX, &count);
    struct work work = { 0 };
    if (scene->charts.side_texel_count == 0) return true;
    bool ok = work_init(&work, task);
    for (uint64_t i = 0; ok && i < count; i++) {
        ok = !bake_task_cancelled(task);
        if (ok) make_matrix(&work, (uint32_t)(first + i), i);
    }
    work_finish(&work);
    return ok;
}

bool prt_add_matrices(struct bake_plan *plan, const struct prt_scene *scene)
{
    enum { MULTIPLY_ADD = 2 };
    const uint64_t texels = light_map_rows(scene->charts.side_texel_count);
    const uint64_t rays = prt_glossy_rays(&scene->options);
    const uint64_t numbers = prt_dimension(&scene->options);
    const size_t tasks = (size_t)((texels + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    const int keep = prt_keep(&scene->options);
    const struct bake_output out[OUT_COUNT] = {
        { PRT_MATRIX, TENSOR_F16, 3, { texels, PRT_OUTGOING, numbers }, BAKE_ROWS, keep },
        { PRT_NORMAL, TENSOR_F32, 2, { texels, 3 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_ROUGHNESS, TENSOR_F32, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
    };
    if (!scene->options.glossy) return true;
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "matrices",
                  .wave = PRT_MATRICES_WAVE,
                  .task_count = tasks,
                  .run = run,
                  .outputs = out,
                  .output_count = OUT_COUNT,
                  .rays = (double)(texels * rays) / (double)tasks,
                  .flops = MULTIPLY_ADD * (double)(texels * rays * PRT_OUTGOING * numbers) /
                           (double)tasks,
                  .scratch_bytes =
                      (size_t)(rays * (numbers + prt_coefficients(&scene->options) + PRT_OUTGOING) *
                                   sizeof(float) +
                               texels * sizeof(uint32_t)) });
}
