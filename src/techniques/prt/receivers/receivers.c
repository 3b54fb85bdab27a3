#include "techniques/prt/receivers/receivers.h"

bool prt_charts(const struct scene_pose *statics, const void *options, struct host *host,
                const struct charts_search *begin, struct charts *out)
{
    enum { MOST_CHARTS = 1 << 20 };
    const struct prt_options *o = options;
    const struct charts_wish wish = { .technique = "prt",
                                      .texels = (uint32_t)o->texels,
                                      .begin = begin,
                                      .density = o->density,
                                      .most_charts = MOST_CHARTS };
    return charts_init_wanted(out, host, statics, &wish);
}

bool prt_receivers_init(struct prt_receivers *out, struct charts *charts, struct host *host,
                        const struct scene_pose *statics, const struct prt_options *options)
{
    *out = (struct prt_receivers){ .host = host,
                                   .at_vertices = options->at == PRT_AT_VERTEX,
                                   .charts = charts };
    if (!out->at_vertices) {
        const bool ok = prt_charts(statics, options, host, NULL, charts);
        out->count = charts->side_texel_count;
        return ok;
    }
    if (options->glossy)
        return host_fail(host, FAIL_UNSUPPORTED,
                         "prt: glossy=true needs the texels of a light map; give at=texel");
    const bool ok = prt_vertices_init(&out->vertices, host, statics);
    out->count = out->vertices.count;
    return ok;
}

void prt_receivers_finish(struct prt_receivers *r)
{
    if (r->charts) charts_finish(r->charts);
    prt_vertices_finish(&r->vertices);
    *r = (struct prt_receivers){ 0 };
}

struct box3 prt_receivers_bounds(const struct prt_receivers *r)
{
    struct box3 box = box3_empty();
    if (!r->at_vertices) return charts_bounds(r->charts);
    for (uint32_t i = 0; i < r->vertices.count; i++)
        box = box3_add_point(box, r->vertices.at[i].position);
    return box;
}

vec3s prt_receiver_normal(const struct prt_receivers *r, uint32_t receiver)
{
    return r->at_vertices ? r->vertices.at[receiver].normal
                          : chart_texel_normal(r->charts, receiver);
}

uint32_t prt_receiver_at(const struct prt_receivers *r, const struct prt_point *p, float choice)
{
    if (!r->at_vertices)
        return chart_texel_at(r->charts, p->instance, p->triangle, p->u, p->v, p->back);
    const uint32_t *corner = prt_vertices_of(&r->vertices, p->instance, p->triangle, p->back);
    return corner[choice < p->u ? 1 : choice < p->u + p->v ? 2 : 0];
}

uint32_t *prt_receivers_nearest_valid(const struct prt_receivers *r, const float *point)
{
    bool *hidden = host_alloc(r->host, r->count, sizeof *hidden);
    for (size_t i = 0; hidden && i < r->count; i++) hidden[i] = !(point[4 * i + 3] > 0.0f);
    uint32_t *nearest_valid = !hidden          ? NULL
                              : r->at_vertices ? prt_vertices_fill(&r->vertices, hidden)
                                               : charts_fill(r->charts, hidden);
    host_free(r->host, hidden);
    return nearest_valid;
}
