// The last stage: transfer vectors as a codebook of clusters, and the cluster and weights of each
// texel.
#include "techniques/prt/bake/scene.h"
#include "techniques/prt/compress/compress.h"

#include "bake/plan.h"
#include "core/half.h"

enum { OUT_CODEBOOK, OUT_CLUSTER, OUT_ERROR, OUT_WEIGHT, OUT_COUNT };
enum { MOST_VECTORS = 32 }; // of the option

struct vectors {
    const uint16_t *direct, *bounce; // NULL: without bounces
    size_t texels, dim;
    uint32_t *texel;          // [points] those that are not inside geometry
    float *at;                // [points][dim]
    struct prt_points points; // of `at`
};

static void fill_point(const struct vectors *v, size_t texel, float *out)
{
    for (size_t k = 0; k < v->dim; k++) {
        const size_t at = (v->bounce ? k / 4 : k) * v->texels + texel;
        const bool direct = !v->bounce || k % 4 == 0;
        out[k] = float_from_half(direct ? v->direct[at] : v->bounce[3 * at + k % 4 - 1]);
    }
}

static bool find_tensors(struct vectors *v, const struct bake_task *task, const float **point)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *direct = bake_task_input(task, PRT_DIRECT);
    const struct tensor *points = bake_task_input(task, LIGHT_MAP_POINT);
    *v = (struct vectors){ 0 };
    if (!direct || !points) return false;
    *point = points->data;
    v->direct = direct->data;
    v->texels = direct->shape[1];
    v->dim = prt_dimension(&scene->options);
    if (scene->options.transfer != PRT_INTERREFLECTED) return true;
    const struct tensor *bounce = bake_task_input(task, PRT_BOUNCE);
    v->bounce = bounce ? bounce->data : NULL;
    return bounce != NULL;
}

static bool vectors_init(struct vectors *v, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const float *point = NULL;
    if (!find_tensors(v, task, &point)) return false;
    v->texel = host_alloc(task->host, v->texels, sizeof *v->texel);
    v->at = host_alloc(task->host, v->texels, v->dim * sizeof *v->at);
    if (!v->texel || !v->at) return false;
    v->points = (struct prt_points){ v->at, 0, v->dim };
    for (uint32_t i = 0; i < scene->charts.side_texel_count; i++) {
        if (!(point[4 * (size_t)i + 3] > 0.0f)) continue;
        v->texel[v->points.count] = i;
        fill_point(v, i, v->at + v->points.count++ * v->dim);
    }
    return true;
}

static void vectors_finish(struct vectors *v, struct host *host)
{
    host_free(host, v->texel);
    host_free(host, v->at);
}

static float rounded(float value)
{
    return float_from_half(half_from_float(value));
}

// Rows become halves; weights are those of the rounded rows.
static void write_codebook(const struct bake_task *task, struct prt_codebook *book)
{
    const size_t count = book->clusters * (1 + book->vectors) * book->dim;
    uint16_t *out = bake_row(task, OUT_CODEBOOK, 0);
    for (size_t i = 0; i < count; i++) {
        out[i] = half_from_float(book->rows[i]);
        book->rows[i] = rounded(book->rows[i]);
    }
}

static double square_error(const struct prt_codebook *book, uint32_t cluster, const float *weights,
                           const float *point)
{
    double sum = 0.0;
    for (size_t d = 0; d < book->dim; d++) {
        double x = (double)prt_codebook_row(book, cluster, 0)[d] - (double)point[d];
        for (size_t k = 0; k < book->vectors; k++)
            x += (double)weights[k] * (double)prt_codebook_row(book, cluster, 1 + k)[d];
        sum += x * x;
    }
    return sum;
}

static void write_texels(const struct bake_task *task, const struct vectors *v,
                         const struct prt_codebook *book)
{
    float weights[MOST_VECTORS], *error = bake_row(task, OUT_ERROR, 0);
    double sum = 0.0;
    for (size_t i = 0; i < v->points.count; i++) {
        const float *point = v->at + i * v->dim;
        const uint32_t cluster = book->cluster[i];
        *(uint16_t *)bake_row(task, OUT_CLUSTER, v->texel[i]) = (uint16_t)cluster;
        prt_weigh(book, cluster, point, weights);
        for (size_t k = 0; k < book->vectors; k++) {
            ((uint16_t *)bake_row(task, OUT_WEIGHT, v->texel[i]))[k] = half_from_float(weights[k]);
            weights[k] = rounded(weights[k]);
        }
        sum += square_error(book, cluster, weights, point);
    }
    error[0] = (float)sum;
    error[1] = (float)prt_variance(&v->points);
}

static bool stop(void *user)
{
    const struct bake_task *const *task = user;
    return bake_task_cancelled(*task);
}

static bool run(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct prt_compression how = { .clusters = prt_clusters(&scene->options),
                                         .vectors = prt_vectors(&scene->options),
                                         .seed = task->bake_seed,
                                         .stop = stop,
                                         .user = &task };
    struct vectors v;
    struct prt_codebook book = { 0 };
    const bool ok = vectors_init(&v, task) && prt_compress(task->host, &v.points, &how, &book);
    if (ok) {
        write_codebook(task, &book);
        write_texels(task, &v, &book);
    }
    prt_codebook_finish(&book);
    vectors_finish(&v, task->host);
    return ok;
}

bool prt_add_compression(struct bake_plan *plan, const struct prt_scene *scene)
{
    enum { ROUNDS = 10 }; // of each kind, about
    const uint64_t texels = light_map_rows(scene->charts.side_texel_count);
    const uint64_t dim = prt_dimension(&scene->options), rows = prt_codebook_rows(&scene->options);
    const uint64_t vectors = prt_vectors(&scene->options);
    const struct bake_output out[OUT_COUNT] = {
        { PRT_CODEBOOK, TENSOR_F16, 2, { rows, dim }, BAKE_ROWS, BAKE_SAVED },
        { PRT_CLUSTER, TENSOR_U16, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { PRT_ERROR, TENSOR_F32, 1, { 2 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_WEIGHT, TENSOR_F16, 2, { texels, vectors }, BAKE_ROWS, BAKE_SAVED },
    };
    if (rows == 0) return true;
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "compression",
                                    .wave = PRT_COMPRESSION_WAVE,
                                    .task_count = 1,
                                    .run = run,
                                    .outputs = out,
                                    .output_count = vectors > 0 ? OUT_COUNT : OUT_WEIGHT,
                                    .flops = 2.0 * ROUNDS * (double)(texels * dim * (rows + dim)),
                                    .scratch_bytes = (size_t)(texels * (2 * dim + 3) * 4) });
}
