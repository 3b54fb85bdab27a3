// The stage of areas: TVA(t, Δt), the area of all texels whose offset from t is in the Voronoi
// region of Δt (equation 8, with t as in equation 9), from prefix sums along the rows.
#include "techniques/ort/bake/offsets.h"
#include "techniques/ort/bake/regions.h"
#include "techniques/ort/bake/stages.h"
#include "techniques/ort/bake/texels.h"

#include "bake/plan.h"

#include <string.h>

enum { MOST_TASKS = 16 }; // each finds the regions again

// In memory with a margin of a width on both sides, so that spans need no bounds.
struct prefix {
    double *sum; // [height][3 · width + 1] area of a row's texels to the left
    size_t stride;
};

static bool make_prefix(struct prefix *out, struct host *host, const struct ort_texels *t)
{
    const struct ort_map *map = &t->scene->map;
    out->stride = 3 * (size_t)map->width + 1;
    out->sum = host_alloc(host, map->height * out->stride, sizeof *out->sum);
    for (uint32_t y = 0; out->sum && y < map->height; y++) {
        double *row = out->sum + y * out->stride;
        for (size_t x = 0; x + 1 < out->stride; x++) {
            const size_t at = x - map->width; // beyond the width on the left, too
            const uint32_t texel =
                at < map->width ? map->texel_at[y * (size_t)map->width + at] : CHART_NONE;
            const double area = texel == CHART_NONE ? 0.0 : (double)ort_texel_area(t, texel);
            row[x + 1] = row[x] + area;
        }
    }
    return out->sum != NULL;
}

static void add_difference(float *restrict sum, const double *restrict high,
                           const double *restrict low, size_t count)
{
    for (size_t x = 0; x < count; x++) sum[x] += (float)(high[x] - low[x]);
}

// The area of the region of an offset around every place.
static void sum_region(const struct ort_map *map, const struct prefix *prefix,
                       const struct ort_regions *regions, uint32_t k, float *plane)
{
    memset(plane, 0, (size_t)map->width * map->height * sizeof *plane);
    for (uint32_t s = regions->first[k]; s < regions->first[k + 1]; s++) {
        const struct ort_span span = regions->spans[s];
        for (uint32_t y = 0; y < map->height; y++) {
            const uint32_t from = y + (uint32_t)span.y;
            if (from >= map->height) continue;
            const double *row = prefix->sum + from * prefix->stride + map->width;
            add_difference(plane + y * (size_t)map->width, row + span.x1 + 1, row + span.x0,
                           map->width);
        }
    }
}

static bool find_regions(const struct bake_task *task, struct ort_regions *out)
{
    const struct ort_scene *scene = task->job;
    const struct tensor *tensor = bake_task_input(task, ORT_OFFSETS);
    if (!tensor) return false;
    const uint32_t count = (uint32_t)tensor->shape[0];
    struct ort_offset *offsets = host_alloc(task->host, count, sizeof *offsets);
    const int32_t *from = tensor->data;
    for (uint32_t k = 0; offsets && k < count; k++)
        offsets[k] = (struct ort_offset){ from[2 * k], from[2 * k + 1] };
    const bool ok = offsets && ort_regions_init(out, task->host, offsets, count, scene->map.width,
                                                scene->map.height);
    host_free(task->host, offsets);
    return ok;
}

static bool write_rows(const struct bake_task *task, const struct prefix *prefix,
                       const struct ort_regions *regions, float *plane)
{
    const struct ort_scene *scene = task->job;
    const struct ort_map *map = &scene->map;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    for (uint64_t i = 0; i < count; i++) {
        if (bake_task_cancelled(task)) return false;
        float *row = bake_row(task, 0, i);
        sum_region(map, prefix, regions, (uint32_t)(first + i), plane);
        for (uint32_t t = 0; t < map->texel_count; t++) {
            const struct ort_place at = ort_place_of(map, t);
            row[t] = plane[at.y * (size_t)map->width + at.x];
        }
    }
    return true;
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct ort_texels texels;
    struct ort_regions regions = { 0 };
    struct prefix prefix = { 0 };
    if (scene->map.texel_count == 0) return true;
    float *plane =
        host_alloc(task->host, (size_t)scene->map.width * scene->map.height, sizeof *plane);
    const bool ok = plane && ort_find_texels(&texels, task) && find_regions(task, &regions) &&
                    make_prefix(&prefix, task->host, &texels) &&
                    write_rows(task, &prefix, &regions, plane);
    host_free(task->host, plane);
    host_free(task->host, prefix.sum);
    ort_regions_finish(&regions);
    return ok;
}

bool ort_add_areas(struct bake_plan *plan, const struct ort_scene *scene)
{
    const struct ort_map *map = &scene->map;
    const uint64_t texels = light_map_rows(map->texel_count);
    const uint64_t count = ort_offset_count(map, &scene->options);
    const size_t tasks = count < MOST_TASKS ? (size_t)count : MOST_TASKS;
    const double places = (double)map->width * (double)map->height;
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "areas",
                                    .wave = 3,
                                    .task_count = tasks,
                                    .run = run,
                                    BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, ORT_AREAS, 4, count, texels)),
                                    // Spans have some ten places a row in the mean.
                                    .flops = places * places / 10.0 / (double)tasks,
                                    .scratch_bytes = (size_t)(places * (4.0 + 3.0 * 8.0)) });
}
