// The stage of areas: TVA(t, Δt), the area of all texels whose offset from t is in the Voronoi
// region of Δt (equation 8, with t as in equation 9), from prefix sums along the rows.
#include "techniques/ort/bake/offsets.h"
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

// The places of a group are within these.
struct window {
    uint32_t x0, y0, x1, y1; // [x0, x1) × [y0, y1)
};

static struct window window_of(const struct ort_map *map, uint32_t group)
{
    struct window w = { map->width, map->height, 0, 0 };
    for (uint32_t m = map->first[group]; m < map->first[group + 1]; m++) {
        const struct ort_place at = ort_place_of(map, map->members[m]);
        if (at.x < w.x0) w.x0 = at.x;
        if (at.y < w.y0) w.y0 = at.y;
        if (at.x >= w.x1) w.x1 = at.x + 1;
        if (at.y >= w.y1) w.y1 = at.y + 1;
    }
    return w;
}

// The area of the region of an offset around every place of a window.
static void sum_region(const struct ort_map *map, const struct prefix *prefix,
                       const struct ort_regions *regions, uint32_t k, struct window w, float *plane)
{
    memset(plane, 0, (size_t)map->width * map->height * sizeof *plane);
    for (uint32_t s = regions->first[k]; s < regions->first[k + 1]; s++) {
        const struct ort_span span = regions->spans[s];
        for (uint32_t y = w.y0; y < w.y1; y++) {
            const uint32_t from = y + (uint32_t)span.y;
            if (from >= map->height) continue;
            const double *row = prefix->sum + from * prefix->stride + map->width + w.x0;
            add_difference(plane + y * (size_t)map->width + w.x0, row + span.x1 + 1, row + span.x0,
                           w.x1 - w.x0);
        }
    }
}

bool ort_find_regions(const struct bake_task *task, uint32_t group, struct ort_regions *out)
{
    const struct ort_scene *scene = task->job;
    const struct tensor *tensor = bake_task_input(task, ORT_OFFSETS);
    if (!tensor) return false;
    const uint32_t count = (uint32_t)tensor->shape[1];
    struct ort_offset *offsets = host_alloc(task->host, count, sizeof *offsets);
    const int32_t *from = (const int32_t *)tensor->data + 2 * (size_t)group * count;
    for (uint32_t k = 0; offsets && k < count; k++)
        offsets[k] = (struct ort_offset){ from[2 * k], from[2 * k + 1] };
    const bool ok = offsets && ort_regions_init(out, task->host, offsets, count, scene->map.width,
                                                scene->map.height);
    host_free(task->host, offsets);
    return ok;
}

struct work {
    const struct bake_task *task;
    struct prefix prefix;
    float *plane; // [width · height]
};

// The texels of a group, for the offsets of the task.
static bool write_group(struct work *w, uint32_t group)
{
    const struct ort_map *map = &((const struct ort_scene *)w->task->job)->map;
    const struct window window = window_of(map, group);
    struct ort_regions regions;
    uint64_t count, first = bake_task_rows(w->task, 0, &count);
    if (!ort_find_regions(w->task, group, &regions)) return false;
    bool ok = true;
    for (uint64_t i = 0; ok && i < count; i++) {
        float *row = bake_row(w->task, 0, i);
        ok = !bake_task_cancelled(w->task);
        sum_region(map, &w->prefix, &regions, (uint32_t)(first + i), window, w->plane);
        for (uint32_t m = map->first[group]; m < map->first[group + 1]; m++) {
            const struct ort_place at = ort_place_of(map, map->members[m]);
            row[map->members[m]] = w->plane[at.y * (size_t)map->width + at.x];
        }
    }
    ort_regions_finish(&regions);
    return ok;
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct ort_texels texels;
    struct work w = { .task = task };
    if (scene->map.texel_count == 0) return true;
    w.plane = host_alloc(task->host, (size_t)scene->map.width * scene->map.height, sizeof *w.plane);
    bool ok =
        w.plane && ort_find_texels(&texels, task) && make_prefix(&w.prefix, task->host, &texels);
    for (uint32_t g = 0; ok && g < scene->map.group_count; g++) ok = write_group(&w, g);
    host_free(task->host, w.plane);
    host_free(task->host, w.prefix.sum);
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
