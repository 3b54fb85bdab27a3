#include "techniques/common/light_map/paint.h"

#include "scene/charts/charts.h"
#include "techniques/common/light_map/table.h"

#include "technique_shaders.h"

#include <math.h>

void light_map_paint_init(struct light_map_paint *out, struct host *host, struct gpu *gpu,
                          const struct charts *charts)
{
    *out = (struct light_map_paint){ .host = host, .gpu = gpu, .charts = charts };
}

// ---- creation

static void clear(struct light_map_paint *p)
{
    gpu_image_destroy(p->gpu, &p->table);
    gpu_pipeline_destroy(p->gpu, &p->write);
    host_free(p->host, p->texels);
    host_free(p->host, p->at);
    p->texels = NULL;
    p->at = NULL;
}

void light_map_paint_finish(struct light_map_paint *p)
{
    if (p->host) clear(p);
    *p = (struct light_map_paint){ 0 };
}

static bool create(struct light_map_paint *p)
{
    const uint32_t count = p->charts->side_texel_count;
    struct gpu_image_desc table = light_map_table(GPU_RGBA32F, count);
    table.name = "paint";
    p->texels = host_alloc(p->host, count, sizeof *p->texels);
    p->at = host_alloc(p->host, count, sizeof *p->at);
    if (!p->texels || !p->at || !gpu_image_create(p->gpu, &table, &p->table) ||
        !gpu_compute_pipeline_create(p->gpu, "paint", &shader_common_light_map_paint_comp, NULL, 0,
                                     &p->write)) {
        clear(p);
        return false;
    }
    for (uint32_t i = 0; i < count; i++) p->texels[i].texel = p->at[i] = i;
    return true;
}

// ---- texels

static float strongest(vec3s v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

static void swap(struct light_map_paint *p, uint32_t a, uint32_t b)
{
    const struct light_map_painted first = p->texels[a];
    p->texels[a] = p->texels[b];
    p->texels[b] = first;
    p->at[p->texels[a].texel] = a;
    p->at[p->texels[b].texel] = b;
}

// Largest irradiance among texels, before and after a change of them.
struct range {
    float before, after;
};

static void set_texel(struct light_map_paint *p, uint32_t texel, vec3s lux, struct range *most)
{
    if (p->at[texel] >= p->pending) swap(p, p->at[texel], p->pending++);
    struct light_map_painted *to = &p->texels[p->at[texel]];
    most->before = fmaxf(most->before, strongest(to->lux));
    most->after = fmaxf(most->after, strongest(lux));
    to->lux = lux;
}

// CHART_NONE: the place shows no texel of its own.
static uint32_t texel_of(const struct charts *charts, uint32_t x, uint32_t y, bool back)
{
    const size_t line = (size_t)(back ? charts->height : 0) + y;
    const uint32_t texel = chart_texel_of_place(charts, line * charts->width + x);
    if (texel == CHART_NONE) return CHART_NONE;
    const struct chart_texel *t = chart_texel_of(charts, texel);
    return t->x == x && t->y == y ? texel : CHART_NONE;
}

static struct range set_area(struct light_map_paint *p, const struct light_map_area *area)
{
    const float *lux = area->lux;
    struct range most = { 0.0f, 0.0f };
    for (uint32_t y = area->y; y < area->y + area->height; y++)
        for (uint32_t x = area->x; x < area->x + area->width; x++) {
            const uint32_t texel = texel_of(p->charts, x, y, area->back);
            const vec3s value = lux ? vec3_of(lux[0], lux[1], lux[2]) : vec3_of(0, 0, 0);
            if (texel != CHART_NONE) set_texel(p, texel, value, &most);
            if (lux) lux += 3;
        }
    return most;
}

static float find_most(const struct light_map_paint *p)
{
    float most = 0.0f;
    for (uint32_t i = 0; i < p->charts->side_texel_count; i++)
        most = fmaxf(most, strongest(p->texels[i].lux));
    return most;
}

// Searches all texels where the largest value has been replaced by a smaller one.
static void update_most(struct light_map_paint *p, struct range of_area)
{
    if (of_area.after >= p->most)
        p->most = of_area.after;
    else if (of_area.before >= p->most)
        p->most = find_most(p);
}

static bool check_range(const struct light_map_paint *p, uint32_t first, uint32_t count,
                        uint32_t size, const char *axis, const char *side)
{
    return (first < size && count > 0 && count <= size - first) ||
           host_fail(p->host, FAIL_ARGUMENT,
                     "painted light: %s %u with a %s of %u texels is beyond the light map's %s "
                     "of %u",
                     axis, first, side, count, side, size);
}

static bool check_values(const struct light_map_paint *p, const struct light_map_area *area)
{
    const size_t count = 3 * (size_t)area->width * area->height;
    for (size_t i = 0; area->lux && i < count; i++)
        if (!(area->lux[i] >= 0.0f && isfinite(area->lux[i])))
            return host_fail(p->host, FAIL_ARGUMENT,
                             "painted light: the texel at %u, %u has %g lux; it must be finite "
                             "and at least 0",
                             area->x + (uint32_t)(i / 3 % area->width),
                             area->y + (uint32_t)(i / 3 / area->width), (double)area->lux[i]);
    return true;
}

static bool check(const struct light_map_paint *p, const struct light_map_area *area)
{
    const struct charts *charts = p->charts;
    if (area->back && charts_sides(charts) < 2)
        return host_fail(p->host, FAIL_ARGUMENT,
                         "painted light: the light map has no backs, no material is double-sided");
    return check_range(p, area->x, area->width, charts->width, "x", "width") &&
           check_range(p, area->y, area->height, charts->height, "y", "height") &&
           check_values(p, area);
}

bool light_map_paint_set(struct light_map_paint *p, const struct light_map_area *area)
{
    if (!check(p, area) || !(p->table.id || create(p))) return false;
    update_most(p, set_area(p, area));
    return true;
}

// ---- frames

bool light_map_paint_record(struct light_map_paint *p, struct gpu_cmd *cmd)
{
    if (p->pending == 0) return false;
    const struct light_map_paint_push push = { p->pending };
    gpu_scope_begin(cmd, "paint");
    gpu_dispatch(cmd, p->write,
                 GPU_BIND(gpu_transient(cmd, "light_map_painted_texels", p->texels,
                                        p->pending * sizeof *p->texels),
                          { .name = "light_map_paint", .image = p->table }),
                 &push, sizeof push, gpu_groups(push.count, LIGHT_MAP_LOCAL), 1, 1);
    gpu_scope_end(cmd);
    p->pending = 0;
    return true;
}
