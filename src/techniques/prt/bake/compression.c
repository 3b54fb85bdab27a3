// The last stage: transfer vectors as a codebook of clusters, and the cluster and weights of each
// texel.
#include "techniques/prt/bake/scene.h"
#include "techniques/prt/compress/compress.h"

#include "bake/plan.h"
#include "core/half.h"

enum { OUT_CODEBOOK, OUT_CLUSTER, OUT_ERROR, OUT_WEIGHT, OUT_COUNT };
enum { MOST_VECTORS = 32 }; // of the option

// Transfer vectors, or matrices.
struct points {
    const uint16_t *direct, *bounce; // of vectors; NULL: without bounces
    const uint16_t *matrix;          // NULL: vectors
    const struct prt_lobes *lobes;   // of matrices, whose distances are those of their functions
    size_t texels, dim;
    uint32_t *texel;       // [count] those that are not inside geometry
    float *at;             // [count][dim]
    struct prt_points all; // of `at`
};

static void fill_point(const struct points *p, size_t texel, float *out)
{
    for (size_t k = 0; k < p->dim; k++) {
        const size_t at = (p->bounce ? k / 4 : k) * p->texels + texel;
        const bool direct = !p->bounce || k % 4 == 0;
        out[k] = float_from_half(p->matrix ? p->matrix[texel * p->dim + k]
                                 : direct  ? p->direct[at]
                                           : p->bounce[3 * at + k % 4 - 1]);
    }
    if (p->matrix) prt_lobes_transform(p->lobes->root, out, p->dim / PRT_OUTGOING);
}

static bool find_vectors(struct points *p, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *direct = bake_task_input(task, PRT_DIRECT);
    if (!direct) return false;
    p->direct = direct->data;
    p->dim = prt_dimension(&scene->options);
    if (!prt_has_bounces(&scene->options)) return true;
    const struct tensor *bounce = bake_task_input(task, PRT_BOUNCE);
    p->bounce = bounce ? bounce->data : NULL;
    return bounce != NULL;
}

static bool find_matrices(struct points *p, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *matrix = bake_task_input(task, PRT_MATRIX);
    p->matrix = matrix ? matrix->data : NULL;
    p->lobes = &scene->lobes;
    p->dim = PRT_OUTGOING * prt_dimension(&scene->options);
    return matrix != NULL;
}

static bool points_init(struct points *p, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *tensor = bake_task_input(task, LIGHT_MAP_POINT);
    const bool *matrices = task->argument;
    *p = (struct points){ .texels = scene->receivers.count };
    if (!tensor || !(*matrices ? find_matrices(p, task) : find_vectors(p, task))) return false;
    const float *point = tensor->data;
    p->texel = host_alloc(task->host, p->texels, sizeof *p->texel);
    p->at = host_alloc(task->host, p->texels, p->dim * sizeof *p->at);
    if (!p->texel || !p->at) return false;
    p->all = (struct prt_points){ p->at, 0, p->dim };
    for (uint32_t i = 0; i < scene->receivers.count; i++) {
        if (!(point[4 * (size_t)i + 3] > 0.0f)) continue;
        p->texel[p->all.count] = i;
        fill_point(p, i, p->at + p->all.count++ * p->dim);
    }
    return true;
}

static void points_finish(struct points *p, struct host *host)
{
    host_free(host, p->texel);
    host_free(host, p->at);
}

static float rounded(float value)
{
    return float_from_half(half_from_float(value));
}

// Rows become halves, of matrices those of functions; weights are those of the rounded rows.
static void write_codebook(const struct bake_task *task, const struct points *p,
                           struct prt_codebook *book)
{
    const size_t rows = book->clusters * (1 + book->vectors), width = book->dim / PRT_OUTGOING;
    uint16_t *out = bake_row(task, OUT_CODEBOOK, 0);
    for (size_t r = 0; r < rows; r++, out += book->dim) {
        float *row = book->rows + r * book->dim;
        if (p->matrix) prt_lobes_transform(p->lobes->inverse_root, row, width);
        for (size_t d = 0; d < book->dim; d++) {
            out[d] = half_from_float(row[d]);
            row[d] = rounded(row[d]);
        }
        if (p->matrix) prt_lobes_transform(p->lobes->root, row, width);
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

static void write_texels(const struct bake_task *task, const struct points *p,
                         const struct prt_codebook *book)
{
    float weights[MOST_VECTORS], *error = bake_row(task, OUT_ERROR, 0);
    double sum = 0.0;
    for (size_t i = 0; i < p->all.count; i++) {
        const float *point = p->at + i * p->dim;
        const uint32_t cluster = book->cluster[i];
        *(uint16_t *)bake_row(task, OUT_CLUSTER, p->texel[i]) = (uint16_t)cluster;
        prt_weigh(book, cluster, point, weights);
        for (size_t k = 0; k < book->vectors; k++) {
            ((uint16_t *)bake_row(task, OUT_WEIGHT, p->texel[i]))[k] = half_from_float(weights[k]);
            weights[k] = rounded(weights[k]);
        }
        sum += square_error(book, cluster, weights, point);
    }
    error[0] = (float)sum;
    error[1] = (float)prt_variance(&p->all);
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
    struct points points;
    struct prt_codebook book = { 0 };
    const bool ok =
        points_init(&points, task) && prt_compress(task->host, &points.all, &how, &book);
    if (ok) {
        write_codebook(task, &points, &book);
        write_texels(task, &points, &book);
    }
    prt_codebook_finish(&book);
    points_finish(&points, task->host);
    return ok;
}

static bool add_stage(struct bake_plan *plan, const struct prt_scene *scene, const char *name,
                      const struct bake_output out[OUT_COUNT], const bool *matrices)
{
    enum { ROUNDS = 10 }; // of each kind, about
    const uint64_t texels = out[OUT_CLUSTER].shape[0], rows = out[OUT_CODEBOOK].shape[0];
    const uint64_t dim =
        prt_dimension(&scene->options) * (*matrices ? (uint64_t)PRT_OUTGOING : UINT64_C(1));
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = name,
                                    .wave = PRT_COMPRESSION_WAVE,
                                    .task_count = 1,
                                    .run = run,
                                    .argument = matrices,
                                    .outputs = out,
                                    .output_count =
                                        prt_vectors(&scene->options) > 0 ? OUT_COUNT : OUT_WEIGHT,
                                    .flops = 2.0 * ROUNDS * (double)(texels * dim * (rows + dim)),
                                    .scratch_bytes = (size_t)(texels * (2 * dim + 3) * 4) });
}

bool prt_add_compression(struct bake_plan *plan, const struct prt_scene *scene)
{
    static const bool VECTORS = false, MATRICES = true;
    const uint64_t texels = light_map_rows(scene->receivers.count);
    const uint64_t dim = prt_dimension(&scene->options), rows = prt_codebook_rows(&scene->options);
    const uint64_t vectors = prt_vectors(&scene->options);
    const struct bake_output of_vectors[OUT_COUNT] = {
        { PRT_CODEBOOK, TENSOR_F16, 2, { rows, dim }, BAKE_ROWS, BAKE_SAVED },
        { PRT_CLUSTER, TENSOR_U16, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { PRT_ERROR, TENSOR_F32, 1, { 2 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_WEIGHT, TENSOR_F16, 2, { texels, vectors }, BAKE_ROWS, BAKE_SAVED },
    };
    const struct bake_output of_matrices[OUT_COUNT] = {
        { PRT_GLOSSY_CODEBOOK, TENSOR_F16, 3, { rows, PRT_OUTGOING, dim }, BAKE_ROWS, BAKE_SAVED },
        { PRT_GLOSSY_CLUSTER, TENSOR_U16, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { PRT_GLOSSY_ERROR, TENSOR_F32, 1, { 2 }, BAKE_ROWS, BAKE_SAVED },
        { PRT_GLOSSY_WEIGHT, TENSOR_F16, 2, { texels, vectors }, BAKE_ROWS, BAKE_SAVED },
    };
    if (rows == 0) return true;
    return add_stage(plan, scene, "compression", of_vectors, &VECTORS) &&
           (!scene->options.glossy ||
            add_stage(plan, scene, "compression of matrices", of_matrices, &MATRICES));
}
