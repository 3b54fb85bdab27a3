// Stages of the bake: rays of all texels, then rows of clusters, which are the means of their
// texels' rows.
#include "techniques/radiosity/radiosity_tensors.h"

#include "bake/scene_key.h"
#include "core/half.h"
#include "trace/texels/close.h"
#include "techniques/radiosity/bake/block.h"
#include "techniques/radiosity/bake/shared_samples.h"
#include "techniques/radiosity/probes/stage.h"
#include "techniques/radiosity/radiosity_strata.h"

#include <string.h>

enum { TEXELS_PER_TASK = 128, CLUSTERS_PER_TASK = 64 };

struct job {
    struct radiosity_scene scene;
    struct seam_closing closing;
    struct radiosity_map map; // before the first run and between runs: without parts
    const struct scene_pose *pose;
    struct radiosity_options options;
};

static bool prepare(void *argument, struct host *host)
{
    struct job *job = argument;
    return radiosity_scene_init(&job->scene, host, job->pose, &job->options, &job->map) &&
           seam_closing_init(&job->closing, host, &job->scene.map.charts, job->scene.trace);
}

static void finish(void *argument)
{
    struct job *job = argument;
    seam_closing_finish(&job->closing);
    job->map = job->scene.map;
    job->scene.map = (struct radiosity_map){ 0 };
    radiosity_scene_finish(&job->scene);
    if (job->map.host && !radiosity_map_subdivide(&job->map, NULL)) radiosity_map_finish(&job->map);
}

static void destroy(void *argument)
{
    struct job *job = argument;
    radiosity_map_finish(&job->map);
}

// Room of a task: factors of all clusters, and one row.
struct scratch {
    struct radiosity_gather gather;
    struct radiosity_rows rows;
    struct radiosity_entry *row;
    struct radiosity_block_rays block; // of the stage of texels
    float *weights;                    // [sources] of the stage of clusters
};

static bool scratch_init(struct scratch *scratch, struct host *host, const struct job *job)
{
    const struct radiosity_tree *tree = &job->scene.map.tree;
    const size_t entries = 2 * (size_t)job->options.sources;
    *scratch = (struct scratch){ .row = host_alloc(host, entries, sizeof *scratch->row),
                                 .weights = host_alloc(host, entries, sizeof(float)) };
    scratch->gather.factor = host_alloc(host, tree->leaves, sizeof *scratch->gather.factor);
    scratch->gather.hit = host_alloc(host, tree->leaves, sizeof *scratch->gather.hit);
    return scratch->row && scratch->weights && scratch->gather.factor && scratch->gather.hit &&
           radiosity_rows_init(&scratch->rows, host, &job->scene);
}

static size_t scratch_size(uint64_t clusters)
{
    const size_t sum = sizeof(struct radiosity_factor) + sizeof(uint32_t);
    const size_t of_node = sum + 2 * sizeof(struct radiosity_entry) + 2 * sizeof(uint32_t);
    return (size_t)clusters * (sum + 2 * of_node);
}

static void scratch_finish(struct scratch *scratch, struct host *host)
{
    radiosity_rows_finish(&scratch->rows);
    radiosity_block_finish(&scratch->block);
    host_free(host, scratch->gather.factor);
    host_free(host, scratch->gather.hit);
    host_free(host, scratch->row);
    host_free(host, scratch->weights);
}

// ---- texels

enum {
    OUT_BLOCK_START,
    OUT_BLOCK_SOURCE,
    OUT_BLOCK_SHARE,
    OUT_FACTOR,
    OUT_SURFACE,
    OUT_SKY,
    OUT_SKY_SHARES,
    OUT_EMISSION,
    OUT_SKY_FLUENCE,
    OUT_EMISSION_FLUENCE,
    OUT_POINT,
    OUT_PART,
    OUT_NEARNESS,
    OUT_COUNT
};

static void write_row(const struct radiosity_factor *row, uint32_t count, uint16_t *factor)
{
    for (uint32_t k = 0; k < count; k++) {
        factor[3 * k] = half_from_float(row[k].weight);
        factor[3 * k + 1] = half_from_float(row[k].along[0]);
        factor[3 * k + 2] = half_from_float(row[k].along[1]);
    }
}

// The sources of a block are in the rows of its texels, one after another.
static void write_block(const struct bake_task *task, struct scratch *scratch, uint64_t i)
{
    const struct job *job = task->job;
    const uint32_t sources = (uint32_t)job->options.sources;
    const struct radiosity_block_rays *block = &scratch->block;
    *(uint8_t *)bake_row(task, OUT_BLOCK_START, i) = 1;
    for (uint32_t k = 0; k < block->share_count; k++) {
        const struct radiosity_share *share = &block->shares[k];
        uint32_t *source = bake_row(task, OUT_BLOCK_SOURCE, i + k / sources);
        uint16_t *of = bake_row(task, OUT_BLOCK_SHARE, i + k / sources);
        source[k % sources] = radiosity_stratum_source(share->node, share->stratum);
        of[k % sources] = half_from_float(share->share);
    }
    for (uint32_t t = 0; t < block->texels; t++)
        write_row(radiosity_block_row(&scratch->block, &scratch->rows, t),
                  scratch->rows.stratum_count, bake_row(task, OUT_FACTOR, i + t));
}

// False: the texel has no rays.
static bool gather_texel(const struct bake_task *task, struct scratch *scratch, uint64_t first,
                         uint64_t i)
{
    const struct job *job = task->job;
    const uint32_t texel = (uint32_t)(first + i);
    struct radiosity_gather *gather = &scratch->gather;
    const struct charts *charts = &job->scene.map.charts;
    const struct texel_point point = texel_find_point(job->scene.trace, charts, texel);
    memcpy(bake_row(task, OUT_POINT, i), &point, sizeof point);
    *(uint8_t *)bake_row(task, OUT_PART, i) = job->scene.part[texel];
    if (point.share == 0.0f) return false;
    radiosity_gather(&job->scene, texel, point.position, task->bake_seed, gather);
    memcpy(bake_row(task, OUT_SKY, i), &gather->light.sky, sizeof gather->light.sky);
    texel_sky_shares(&gather->light, bake_row(task, OUT_SKY_SHARES, i));
    memcpy(bake_row(task, OUT_EMISSION, i), gather->light.columns,
           (size_t)job->scene.statics.emission.count * sizeof *gather->light.columns);
    *(float *)bake_row(task, OUT_SKY_FLUENCE, i) = gather->light.sky_fluence;
    memcpy(bake_row(task, OUT_EMISSION_FLUENCE, i), gather->light.column_fluence,
           (size_t)job->scene.statics.emission.count * sizeof(float));
    memcpy(bake_row(task, OUT_NEARNESS, i), gather->nearness.raw, sizeof gather->nearness.raw);
    const struct texel_factors factors = texel_free_factors(job->scene.trace, charts, texel);
    memcpy(bake_row(task, OUT_SURFACE, i), &factors, sizeof factors);
    return true;
}

static void gather_block(const struct bake_task *task, struct scratch *scratch, uint64_t first,
                         uint64_t i, uint32_t texels)
{
    const struct job *job = task->job;
    const struct chart_texel *place = chart_texel_of(&job->scene.map.charts, (uint32_t)(first + i));
    radiosity_block_begin(&scratch->block);
    for (uint32_t t = 0; t < texels; t++)
        radiosity_block_add(&scratch->block,
                            gather_texel(task, scratch, first, i + t) ? &scratch->gather : NULL);
    radiosity_block_end(
        &scratch->block, &scratch->rows, (uint32_t)job->options.sources,
        radiosity_shared_phase(place->x / RADIOSITY_BLOCK_EDGE, place->y / RADIOSITY_BLOCK_EDGE));
    write_block(task, scratch, i);
}

static bool run_texels(const struct bake_task *task)
{
    const struct job *job = task->job;
    uint64_t count, first = bake_task_rows(task, OUT_FACTOR, &count);
    struct scratch scratch;
    bool ok = scratch_init(&scratch, task->host, job) &&
              radiosity_block_init(&scratch.block, task->host, &job->scene);
    if (job->scene.map.texel_count == 0) count = 0;
    for (uint64_t i = 0; ok && i < count;) {
        ok = !bake_task_cancelled(task);
        if (!ok) break;
        const uint32_t texels =
            radiosity_block_texels(&job->scene, (uint32_t)(first + i), (uint32_t)(count - i));
        gather_block(task, &scratch, first, i, texels);
        i += texels;
    }
    scratch_finish(&scratch, task->host);
    return ok;
}

static bool add_texels(struct bake_plan *plan, const struct job *job, uint64_t texels,
                       uint64_t clusters, uint64_t columns)
{
    const uint64_t sources = (uint64_t)job->options.sources;
    const struct bake_output out[OUT_COUNT] = {
        { RADIOSITY_BLOCK_START, TENSOR_U8, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_BLOCK_SOURCE, TENSOR_U32, 2, { texels, sources }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_BLOCK_SHARE, TENSOR_F16, 2, { texels, sources }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_FACTOR, TENSOR_F16, 3, { texels, sources, 3 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_SURFACE, TENSOR_F32, 2, { texels, 10 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY_SHARES,
          TENSOR_U8,
          2,
          { texels, ENVIRONMENT_PATCHES },
          BAKE_ROWS,
          BAKE_SAVED },
        { LIGHT_MAP_EMISSION, TENSOR_F32, 3, { texels, columns, 4 }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_SKY_FLUENCE, TENSOR_F32, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_EMISSION_FLUENCE, TENSOR_F32, 2, { texels, columns }, BAKE_ROWS, BAKE_SAVED },
        { LIGHT_MAP_POINT, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_PART, TENSOR_U8, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_NEARNESS, TENSOR_F32, 2, { texels, 4 }, BAKE_ROWS, BAKE_SAVED },
    };
    const size_t tasks = (size_t)((texels + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    return bake_plan_add(
        plan,
        &(struct bake_stage){ .name = "texels",
                              .wave = 0,
                              .task_count = tasks,
                              .run = run_texels,
                              .outputs = out,
                              .output_count = OUT_COUNT,
                              .rays = (double)texels * job->options.rays / (double)tasks,
                              .texels = (double)texels / (double)tasks,
                              .scratch_bytes = scratch_size(clusters) +
                                               radiosity_block_bytes(clusters, &job->options) });
}

// ---- probes

static bool run_probes(const struct bake_task *task)
{
    const struct job *job = task->job;
    struct scratch scratch;
    const bool ok = scratch_init(&scratch, task->host, job) &&
                    radiosity_probe_run(task, &job->scene,
                                        &(struct radiosity_probe_scratch){
                                            &scratch.gather, &scratch.rows, scratch.row });
    scratch_finish(&scratch, task->host);
    return ok;
}

// ---- clusters

struct clusters {
    const struct radiosity_map *map;
    struct radiosity_block_rows blocks;
    const uint16_t *factor;
    const struct texel_point *points;
    float *area; // [clusters] of the texels, as far as they are open, m²
};

static float area_of(const struct clusters *of, uint32_t texel)
{
    return of->points[texel].share * chart_texel_of(&of->map->charts, texel)->area_m2;
}

static void find_areas(const struct clusters *of)
{
    for (uint32_t i = 0; i < of->map->texel_count; i++)
        of->area[of->map->cluster_of[i]] += area_of(of, i);
}

// A node's weight is that of its clusters by area, as its radiosity is their mean.
static void add_node(const struct clusters *of, const struct radiosity_node *node, float weight,
                     struct radiosity_gather *sum)
{
    float area = 0.0f;
    for (uint32_t c = node->first; c < node->first + node->count; c++) area += of->area[c];
    for (uint32_t c = node->first; c < node->first + node->count; c++) {
        const float part = area > 0.0f ? weight * of->area[c] / area : 0.0f;
        if (!(part > 0.0f)) continue;
        if (sum->factor[c].weight == 0.0f) sum->hit[sum->hit_count++] = c;
        sum->factor[c].weight += part;
    }
}

// Adds the sources of a block, each with its share of the weight of its stratum.
static void add_block(const struct clusters *of, uint32_t first, const float *weights,
                      struct radiosity_gather *sum)
{
    const struct radiosity_block_rows *rows = &of->blocks;
    const size_t end = radiosity_block_after(rows, first) * rows->sources;
    for (size_t k = first * rows->sources; k < end && rows->share[k] != 0; k++) {
        const float weight = weights[radiosity_source_stratum(rows->source[k])];
        if (weight > 0.0f)
            add_node(of, &of->map->tree.nodes[radiosity_source_node(rows->source[k])],
                     weight * float_from_half(rows->share[k]), sum);
    }
}

// Adds the texel's factors by stratum.
static void add_factors(const struct clusters *of, uint32_t texel, float share, float *weights)
{
    const size_t sources = of->blocks.sources;
    for (size_t k = 0; k < sources; k++)
        weights[k] += share * float_from_half(of->factor[3 * (texel * sources + k)]);
}

static uint32_t block_of(const struct clusters *of, uint32_t texel)
{
    while (texel > 0 && of->blocks.start[texel] == 0) texel--;
    return texel;
}

// Sums the rows of a cluster's texels, those of a block at once. weights: [sources].
static void sum_texels(const struct clusters *of, uint32_t cluster, float *weights,
                       struct radiosity_gather *sum)
{
    const size_t bytes = of->blocks.sources * sizeof *weights;
    for (uint32_t i = 0; i < sum->hit_count; i++) sum->factor[sum->hit[i]].weight = 0.0f;
    sum->hit_count = 0;
    if (!(of->area[cluster] > 0.0f)) return;
    const uint32_t end = of->map->first[cluster + 1];
    memset(weights, 0, bytes);
    for (uint32_t m = of->map->first[cluster]; m < end; m++) {
        const uint32_t texel = of->map->members[m], block = block_of(of, texel);
        add_factors(of, texel, area_of(of, texel) / of->area[cluster], weights);
        if (m + 1 < end && block_of(of, of->map->members[m + 1]) == block) continue;
        add_block(of, block, weights, sum);
        memset(weights, 0, bytes);
    }
}

static float phase_of(const struct radiosity_map *map, uint32_t cluster)
{
    const struct chart_texel *t = chart_texel_of(&map->charts, map->members[map->first[cluster]]);
    return radiosity_shared_phase(t->x / map->edge, t->y / map->edge);
}

static void merge_rows(const struct bake_task *task, const struct clusters *of,
                       struct scratch *scratch)
{
    const size_t most = 2 * of->blocks.sources;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    for (uint64_t i = 0; i < count && first + i < of->map->cluster_count; i++) {
        sum_texels(of, (uint32_t)(first + i), scratch->weights, &scratch->gather);
        const uint32_t entries =
            radiosity_make_row(&scratch->rows, &scratch->gather, (uint32_t)most,
                               phase_of(of->map, (uint32_t)(first + i)), scratch->row);
        uint32_t *source = bake_row(task, 0, i);
        uint16_t *factor = bake_row(task, 1, i);
        for (uint32_t k = 0; k < entries; k++) {
            source[k] = scratch->row[k].node;
            factor[k] = half_from_float(scratch->row[k].factor.weight);
        }
    }
}

static bool run_clusters(const struct bake_task *task)
{
    const struct job *job = task->job;
    const struct tensor *start = bake_task_input(task, RADIOSITY_BLOCK_START);
    const struct tensor *source = bake_task_input(task, RADIOSITY_BLOCK_SOURCE);
    const struct tensor *share = bake_task_input(task, RADIOSITY_BLOCK_SHARE);
    const struct tensor *factor = bake_task_input(task, RADIOSITY_FACTOR);
    const struct tensor *points = bake_task_input(task, LIGHT_MAP_POINT);
    if (!start || !source || !share || !factor || !points) return false;
    const struct radiosity_map *map = &job->scene.map;
    const struct clusters of = { map,
                                 { start->data, source->data, share->data, map->texel_count,
                                   (size_t)job->options.sources },
                                 factor->data,
                                 points->data,
                                 host_alloc(task->host, map->cluster_count, sizeof(float)) };
    struct scratch scratch;
    const bool ok = scratch_init(&scratch, task->host, job) && of.area;
    if (ok) {
        find_areas(&of);
        merge_rows(task, &of, &scratch);
    }
    scratch_finish(&scratch, task->host);
    host_free(task->host, of.area);
    return ok;
}

// Each entry of the texels' rows is walked up the tree, which takes as long as a ray.
static bool add_clusters(struct bake_plan *plan, const struct job *job, uint64_t texels,
                         uint64_t clusters)
{
    const uint64_t most = 2 * (uint64_t)job->options.sources;
    const size_t tasks = (size_t)((clusters + CLUSTERS_PER_TASK - 1) / CLUSTERS_PER_TASK);
    const struct bake_output out[] = {
        { RADIOSITY_CLUSTER_SOURCE, TENSOR_U32, 2, { clusters, most }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_CLUSTER_FACTOR, TENSOR_F16, 2, { clusters, most }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "clusters",
                                    .wave = 1,
                                    .task_count = tasks,
                                    .run = run_clusters,
                                    .outputs = out,
                                    .output_count = 2,
                                    .others = (double)texels * (double)job->options.sources /
                                              (double)tasks,
                                    .scratch_bytes = scratch_size(clusters) });
}

// Bytes of the map and of a trace scene.
static size_t prepared_bytes(const struct radiosity_map *map)
{
    const struct charts *charts = &map->charts;
    const size_t atlas = (size_t)charts->width * charts->height;
    return charts->triangle_count * (sizeof *charts->triangles + TRACE_TRIANGLE_BYTES) +
           atlas * sizeof *charts->owner + charts->texel_count * sizeof *charts->texels +
           map->texel_count * 2 * sizeof(uint32_t) +
           2 * (size_t)map->cluster_count * (2 * sizeof *map->tree.nodes + sizeof(uint32_t));
}

static bool plan_at(struct bake_plan *plan, const void *user, float texels_per_m)
{
    const struct job *job = user;
    struct radiosity_options options = job->options;
    options.density = texels_per_m;
    return radiosity_bake(plan, &(struct technique_bake){ .pose = job->pose, .options = &options });
}

static bool add_stages(struct bake_plan *plan, struct job *job, const struct scene_statics *of)
{
    const struct scene_pose *statics = &of->pose;
    const uint64_t columns = emission_basis_rows(&of->emission);
    bake_plan_depends(plan, scene_key(statics, SCENE_KEY_GEOMETRY | SCENE_KEY_MATERIALS));
    // The size of the tensors is that of the charts: clusters are not divided yet.
    struct radiosity_map *map = &job->map;
    if (!radiosity_map_init(map, bake_plan_host(plan), statics, &job->options)) return false;
    bake_plan_set_job(plan, &(struct bake_job){ .job = job,
                                                .prepare = prepare,
                                                .finish = finish,
                                                .destroy = destroy,
                                                .bytes = prepared_bytes(map) });
    bake_plan_set_light_map(plan,
                            (struct bake_light_map){ map->charts.count, map->charts.texels_per_m,
                                                     charts_utilisation(&map->charts), plan_at });
    const uint64_t texels = light_map_rows(map->texel_count);
    const uint64_t clusters = radiosity_cluster_rows(map);
    const struct frame_probes grid = radiosity_probe_grid(map, &job->options);
    return add_texels(plan, job, texels, clusters, columns) &&
           radiosity_probe_plan(
               plan, grid,
               &(struct radiosity_probe_size){ job->options.rays, job->options.sources, columns },
               run_probes, scratch_size(clusters)) &&
           add_clusters(plan, job, texels, clusters) &&
           light_map_add_walls(plan, &job->closing, &map->charts) &&
           light_map_add_seams(plan, &job->closing, &map->charts);
}

bool radiosity_bake(struct bake_plan *plan, const struct technique_bake *how)
{
    struct job *job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) return false;
    job->pose = how->pose;
    job->options = *(const struct radiosity_options *)how->options;
    struct scene_statics statics;
    if (!scene_statics_init(&statics, bake_plan_host(plan), how->pose)) return false;
    const bool ok = scene_statics_free_factors(&statics, true) && add_stages(plan, job, &statics);
    scene_statics_finish(&statics);
    return ok;
}
