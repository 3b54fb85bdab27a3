// From a pose to charts: triangles, growth at a density, packing; again at a lower density where
// the atlas has too many texels.
#include "scene/charts/grow.h"
#include "scene/charts/join.h"
#include "scene/charts/pack.h"
#include "scene/charts/sides.h"
#include "scene/charts/texels.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// A density at which charts may fit: their surfaces, and their edges as far as triangles share
// texels at them, bound the texels that are rasterised.
static double first_density(const struct surface *surface, const struct charts_options *options)
{
    const double most = (double)options->max_texels;
    double density = (double)options->texels_per_m;
    density = fmin(density, sqrt(most / surface->area_m2));
    if (options->surface_texels > 0)
        density = fmin(density, sqrt((double)options->surface_texels / surface->area_m2));
    density = fmin(density, 0.25 * (double)CHART_MAX_SIDE / (double)surface->longest_m);
    return fmin(density, 16.0 * most / surface->edges_m);
}

static void place_triangle(struct chart_triangle *out, const struct chart *chart,
                           double place[3][2])
{
    for (int k = 0; k < 3; k++) {
        double own[2] = { 0.5, 0.5 }, at[2];
        if (!chart->single_texel) memcpy(own, place[k], sizeof own);
        for (int a = 0; a < 2; a++) own[a] += CHART_GUTTER;
        pack_place(chart, own, at);
        out->place[k] = (vec2s){ { (float)at[0], (float)at[1] } };
    }
}

static void add_triangle(struct charts *out, const struct surface *surface,
                         const struct grown *grown, uint32_t at)
{
    const uint32_t source = grown->order[at];
    const struct surface_triangle *from = &surface->triangles[source];
    struct chart_triangle *to = &out->triangles[at];
    *to = (struct chart_triangle){ .instance = from->instance,
                                   .triangle = from->triangle,
                                   .chart = grown->chart_of[source],
                                   .normal = from->normal,
                                   .area_m2 = from->area_m2 };
    struct chart *chart = &out->charts[to->chart];
    if (at == chart->first_triangle) chart->instance = from->instance;
    chart->area_m2 += from->area_m2;
    memcpy(to->corner, from->corner, sizeof to->corner);
    memcpy(to->vertex_normal, from->vertex_normal, sizeof to->vertex_normal);
    place_triangle(to, chart, grown->place[source]);
}

static bool start_charts(struct charts *out, const struct grown *grown)
{
    out->count = grown->count;
    out->charts = host_alloc(out->host, grown->count, sizeof *out->charts);
    if (!out->charts) return false;
    for (uint32_t i = 0; i < grown->count; i++) {
        const struct grown_chart *from = &grown->charts[i];
        out->charts[i] = (struct chart){ .unwrapped = from->unwrapped,
                                         .single_texel = from->single_texel,
                                         .first_triangle = from->first_triangle,
                                         .triangle_count = from->triangle_count,
                                         .normal = from->normal };
    }
    return true;
}

static bool finish_charts(struct charts *out, const struct surface *surface,
                          const struct grown *grown)
{
    out->triangle_count = surface->count;
    out->triangles = host_alloc(out->host, surface->count, sizeof *out->triangles);
    if (!out->triangles) return false;
    for (uint32_t i = 0; i < surface->count; i++) add_triangle(out, surface, grown, i);
    return make_chart_texels(out);
}

// *packed: false where the density is too high.
static bool try_density(struct charts *out, const struct surface *surface, double density,
                        const struct charts_options *options, bool *packed)
{
    struct grown grown = { 0 };
    *packed = false;
    out->texels_per_m = (float)density;
    bool ok = grow_charts(&grown, out->host, surface, density);
    if (ok && options->join != CHARTS_APART)
        ok = join_small_charts(&grown, surface, density, options->join == CHARTS_JOINED_ACROSS);
    ok = ok && start_charts(out, &grown) && pack_charts(out, &grown, options->max_texels, packed);
    if (ok && *packed) ok = finish_charts(out, surface, &grown);
    grown_finish(&grown);
    return ok;
}

static void clear(struct charts *charts)
{
    host_free(charts->host, charts->charts);
    host_free(charts->host, charts->triangles);
    host_free(charts->host, charts->texels);
    host_free(charts->host, charts->owner);
    host_free(charts->host, charts->front_of);
    host_free(charts->host, charts->triangle_0);
    host_free(charts->host, charts->chart_triangle);
    host_free(charts->host, charts->pages);
    *charts = (struct charts){ .host = charts->host, .without_area = charts->without_area };
}

// The option that makes twice the room of the smallest atlas so far; 0: it is out of range.
static uint64_t enough_texels(const struct charts *out, const struct charts_options *options)
{
    const uint64_t least = (uint64_t)out->width * out->height;
    if (options->atlas_per_texel == 0 || least <= options->max_texels ||
        out->count > options->most_charts)
        return 0;
    const uint64_t enough = 2 * least / options->atlas_per_texel + 1;
    return enough <= options->most_texels ? enough : 0;
}

static bool refuse(const struct charts *out, const char *scene,
                   const struct charts_options *options)
{
    const uint64_t enough = enough_texels(out, options);
    char remedy[64] = "merge meshes of few triangles";
    if (enough > 0) snprintf(remedy, sizeof remedy, "try texels=%llu", (unsigned long long)enough);
    return host_fail(out->host, FAIL_MEMORY, "charts of %s: %u charts do not fit in %u texels; %s",
                     scene, out->count, options->max_texels, remedy);
}

enum { DENSITY_TRIES = 12 };

static bool are_least(const struct charts *charts)
{
    for (uint32_t i = 0; i < charts->count; i++) {
        const struct chart *chart = &charts->charts[i];
        const uint32_t least = 1 + 2 * CHART_GUTTER;
        if (chart->width > least || chart->height > least) return false;
    }
    return true;
}

// Charts of one texel do not shrink with the density, nor do gutters; but at a lower one more of
// them may be joined. LOWEST_TRY: the density of the last try, where each is nine tenths of the one
// before.
static const double LOWEST_TRY = 0.28;

static bool is_hopeless(const struct charts *charts, const struct surface *surface, double density,
                        const struct charts_options *options, bool *hopeless)
{
    struct charts lowest = { .host = charts->host };
    bool packed = false;
    *hopeless = false;
    if (!are_least(charts)) return true;
    const bool ok = try_density(&lowest, surface, LOWEST_TRY * density, options, &packed);
    *hopeless = ok && lowest.count == charts->count;
    clear(&lowest);
    return ok;
}

static bool find_density(struct charts *out, const struct scene_pose *pose,
                         const struct surface *surface, const struct charts_options *options)
{
    double density = first_density(surface, options);
    for (int i = 0; i < DENSITY_TRIES && density > 0.0; i++) {
        bool packed, hopeless = false;
        clear(out);
        if (!try_density(out, surface, density, options, &packed)) return false;
        if (packed) return true;
        if (i == 0 && !is_hopeless(out, surface, density, options, &hopeless)) return false;
        if (hopeless) break;
        const double texels = (double)out->width * (double)out->height;
        const double ratio = sqrt((double)options->max_texels / fmax(texels, 1.0));
        density *= fmin(fmax(0.97 * ratio, 0.25), 0.9);
    }
    return refuse(out, pose->scene->name, options);
}

bool charts_init(struct charts *out, struct host *host, const struct scene_pose *pose,
                 const struct charts_options *options)
{
    struct surface surface = { 0 };
    *out = (struct charts){ .host = host };
    bool ok = surface_init(&surface, host, pose, options->chosen, options->coordinates);
    out->without_area = surface.without_area;
    if (ok && surface.count > 0) ok = find_density(out, pose, &surface, options);
    ok = ok && make_chart_sides(out, pose->scene);
    surface_finish(&surface);
    if (!ok) charts_finish(out);
    return ok;
}

void charts_finish(struct charts *charts)
{
    if (charts->host) clear(charts);
    *charts = (struct charts){ 0 };
}

struct box3 charts_bounds(const struct charts *charts)
{
    struct box3 box = box3_empty();
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        for (int c = 0; c < 3; c++) box = box3_add_point(box, charts->triangles[t].corner[c]);
    return box;
}
