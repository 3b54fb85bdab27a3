// The members of a report.
#include "lightmap/quality/measures.h"

#include <math.h>

struct naming {
    struct report *report;
    const struct charts *charts;
    const struct scene *scene;
};

static const char *or_empty(const char *name)
{
    return name ? name : "";
}

static void write_position(struct report *report, vec3s position)
{
    report_begin_list(report, "position");
    for (int k = 0; k < 3; k++) report_number(report, NULL, (double)position.raw[k]);
    report_end(report);
}

// An object of a chart's number and names.
static void write_chart(const struct naming *n, const char *name, uint32_t chart)
{
    const int instance = n->charts->charts[chart].instance;
    const struct instance *of = &n->scene->instances[instance];
    report_begin_object(n->report, name);
    report_number(n->report, "chart", chart);
    report_number(n->report, "instance", instance);
    report_text_value(n->report, "name", or_empty(n->scene->nodes[of->node].name));
    report_text_value(n->report, "mesh", or_empty(n->scene->meshes[of->mesh].name));
    if (charts_page_count(n->charts) > 1)
        report_number(n->report, "page", n->charts->charts[chart].page);
    report_end(n->report);
}

static void write_charts_of(const struct naming *n, const struct quality_step *step)
{
    report_begin_list(n->report, "charts");
    write_chart(n, NULL, step->chart[0]);
    if (step->chart[1] != step->chart[0]) write_chart(n, NULL, step->chart[1]);
    report_end(n->report);
}

static void write_steps(const struct naming *n, const struct quality_steps *steps, bool closed)
{
    report_begin_list(n->report, "worst");
    for (int i = 0; i < steps->count; i++) {
        const struct quality_step *step = &steps->at[i];
        report_begin_object(n->report, NULL);
        report_number(n->report, "step", (double)step->step);
        if (closed) report_number(n->report, "step_before", (double)step->before);
        report_begin_list(n->report, "lux");
        for (int k = 0; k < 2; k++) report_number(n->report, NULL, (double)step->light[k]);
        report_end(n->report);
        write_position(n->report, step->position);
        report_bool(n->report, "back", step->back);
        write_charts_of(n, step);
        report_end(n->report);
    }
    report_end(n->report);
}

// ---- charts

static void write_classes(struct report *report, const struct quality_class *classes, int count,
                          double first, double factor, const char *amount)
{
    report_begin_list(report, "classes");
    for (int i = 0; i < count; i++) {
        report_begin_object(report, NULL);
        report_number(report, "from", first * pow(factor, i));
        report_number(report, "charts", classes[i].charts);
        report_number(report, amount, classes[i].amount);
        report_end(report);
    }
    report_end(report);
}

static void write_density(struct report *report, const struct quality_charts *q,
                          const struct charts *charts)
{
    const double reached = (double)charts->texels_per_m;
    // A class has densities within a quarter of a factor of 2 of its middle.
    const double first = reached * exp2(-DENSITY_CLASSES / 4.0 - 0.25);
    report_begin_object(report, "density");
    report_number(report, "wanted", q->wanted > 0.0f ? (double)q->wanted : (double)NAN);
    report_number(report, "reached", reached);
    report_number(report, "median", (double)q->median);
    report_number(report, "least", (double)q->least);
    write_classes(report, q->densities, DENSITY_CLASSES, first, sqrt(2.0), "area_m2");
    report_end(report);
}

static void write_charts(struct report *report, const struct quality_charts *q,
                         const struct charts *charts)
{
    report_begin_object(report, "charts");
    report_number(report, "count", charts->count);
    report_number(report, "unwrapped", q->unwrapped);
    report_number(report, "single_texel", q->single_texel);
    report_number(report, "inside_geometry", q->dark);
    int count = SIZE_CLASSES;
    while (count > 1 && q->sizes[count - 1].charts == 0) count--;
    write_classes(report, q->sizes, count, 1.0, 2.0, "texels");
    report_end(report);
}

static void write_texels(struct report *report, const struct lightmap_quality *q,
                         const struct lightmap *map)
{
    report_begin_object(report, "texels");
    report_number(report, "count", map->charts.side_texel_count);
    report_number(report, "atlas", charts_page_places(&map->charts));
    report_number(report, "utilisation", (double)charts_utilisation(&map->charts));
    report_number(report, "filled", q->filled);
    report_number(report, "partly_inside", q->partly);
    report_end(report);
    report_begin_object(report, "overlaps");
    report_number(report, "shared", q->overlaps.shared);
    report_number(report, "folded", q->overlaps.folded);
    report_end(report);
}

// ---- light

static void write_seam_state(struct report *report, const char *name,
                             const struct quality_seam_state *state)
{
    report_begin_object(report, name);
    report_number(report, "mean", state->mean);
    report_number(report, "largest", state->largest);
    report_number(report, "above_5_percent", state->above);
    report_end(report);
}

static void write_seams(const struct naming *n, const struct lightmap_quality *q)
{
    report_begin_object(n->report, "seams");
    report_number(n->report, "texels", q->seams.texels);
    write_seam_state(n->report, "before", &q->seams.unclosed);
    write_seam_state(n->report, "after", &q->seams.closed);
    write_steps(n, &q->seams.worst, true);
    report_end(n->report);
}

static void write_leaks(const struct naming *n, const struct lightmap_quality *q)
{
    report_begin_object(n->report, "leaks");
    report_number(n->report, "texels", q->leaks.texels);
    write_steps(n, &q->leaks.worst, false);
    report_end(n->report);
}

static void write_noisy(const struct naming *n, const struct quality_noisy *noisy)
{
    report_begin_object(n->report, NULL);
    report_number(n->report, "noise", (double)noisy->noise);
    report_number(n->report, "texels", noisy->texels);
    report_number(n->report, "charts", noisy->charts);
    report_bool(n->report, "back", noisy->back);
    write_position(n->report,
                   n->charts->triangles[n->charts->charts[noisy->chart].first_triangle].corner[0]);
    write_chart(n, "first", noisy->chart);
    report_end(n->report);
}

static void write_noise(const struct naming *n, const struct quality_noise *noise)
{
    if (!noise->known) return;
    report_begin_object(n->report, "noise");
    report_number(n->report, "largest", (double)noise->largest);
    report_number(n->report, "median", (double)noise->median);
    report_begin_list(n->report, "worst");
    for (int i = 0; i < noise->count; i++) write_noisy(n, &noise->worst[i]);
    report_end(n->report);
    report_end(n->report);
}

void quality_report(struct report *report, const struct lightmap_quality *q,
                    const struct lightmap *map, const struct scene *scene)
{
    const struct naming n = { report, &map->charts, scene };
    write_density(report, &q->charts, &map->charts);
    write_texels(report, q, map);
    write_charts(report, &q->charts, &map->charts);
    write_seams(&n, q);
    write_leaks(&n, q);
    write_noise(&n, &q->noise);
}
