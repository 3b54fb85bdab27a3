// The stage of links: whether the light of a texel may be averaged with that of the next one, to
// the right and below. Links stay within a side of a chart and do not cross walls.
#include "techniques/ort/bake/stages.h"
#include "techniques/ort/bake/texels.h"

#include "bake/plan.h"

#include <math.h>

enum { TEXELS_PER_TASK = 4096 };

// Half the distance between two texels above them: above the surface between the two, if it is
// curved, and below the lower edge of most things that hang.
static vec3s raise(const struct ort_texel *texel, float spacing)
{
    return glms_vec3_muladds(texel->normal, fmaxf(texel->reach, 0.5f * spacing), texel->position);
}

static bool are_linked(const struct ort_texels *t, uint32_t a, uint32_t b)
{
    const struct charts *charts = &t->scene->map.charts;
    if (b == CHART_NONE || chart_is_back(charts, a) != chart_is_back(charts, b) ||
        chart_triangle_of(charts, a)->chart != chart_triangle_of(charts, b)->chart)
        return false;
    const struct ort_texel from = ort_texel_of(t, a), to = ort_texel_of(t, b);
    if (!(from.area > 0.0f && to.area > 0.0f)) return false;
    const float spacing = glms_vec3_distance(from.position, to.position);
    const vec3s begin = raise(&from, spacing), end = raise(&to, spacing);
    return !trace_occluded(t->scene->trace, begin, glms_vec3_sub(end, begin), 1.0f);
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct ort_texels texels;
    uint64_t count, first = bake_task_rows(task, 0, &count);
    if (scene->map.texel_count == 0) return true;
    if (!ort_find_texels(&texels, task)) return false;
    for (uint64_t i = 0; i < count; i++) {
        const uint32_t texel = (uint32_t)(first + i);
        const struct ort_place at = ort_place_of(&scene->map, texel);
        uint8_t *link = bake_row(task, 0, i);
        if (bake_task_cancelled(task)) return false;
        if (are_linked(&texels, texel, ort_texel_at(&scene->map, at, 1, 0))) *link |= ORT_LINK_X;
        if (are_linked(&texels, texel, ort_texel_at(&scene->map, at, 0, 1))) *link |= ORT_LINK_Y;
    }
    return true;
}

bool ort_add_links(struct bake_plan *plan, const struct ort_scene *scene)
{
    const uint64_t texels = light_map_rows(scene->map.texel_count);
    const size_t tasks = (size_t)((texels + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    const struct bake_output out[] = {
        { ORT_LINKS, TENSOR_U8, 1, { texels }, BAKE_ROWS, BAKE_SAVED },
    };
    return bake_plan_add(plan,
                         &(struct bake_stage){ .name = "links",
                                               .wave = 1,
                                               .task_count = tasks,
                                               .run = run,
                                               .outputs = out,
                                               .output_count = 1,
                                               .rays = 2.0 * (double)texels / (double)tasks });
}
