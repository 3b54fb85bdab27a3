// Copies of charts.
#include "scene/charts/charts.h"

#include <string.h>

// NULL stays NULL.
static void *copy(struct host *host, const void *from, size_t count, size_t size, bool *ok)
{
    void *out = from && *ok ? host_alloc(host, count, size) : NULL;
    if (out && count > 0) memcpy(out, from, count * size);
    *ok = *ok && (out || !from);
    return out;
}

bool charts_copy(struct charts *out, const struct charts *from, int instance_count)
{
    struct host *host = from->host;
    const size_t instances = (size_t)instance_count;
    const size_t backs = from->side_texel_count - from->texel_count;
    const size_t triangles = from->triangle_0 ? from->triangle_0[instances] : 0;
    bool ok = true;
    *out = *from;
    out->charts = copy(host, from->charts, from->count, sizeof *from->charts, &ok);
    out->triangles =
        copy(host, from->triangles, from->triangle_count, sizeof *from->triangles, &ok);
    out->texels = copy(host, from->texels, from->texel_count, sizeof *from->texels, &ok);
    out->front_of = copy(host, from->front_of, backs, sizeof *from->front_of, &ok);
    out->owner =
        copy(host, from->owner, (size_t)from->width * from->height, sizeof *from->owner, &ok);
    out->triangle_0 = copy(host, from->triangle_0, instances + 1, sizeof *from->triangle_0, &ok);
    out->chart_triangle =
        copy(host, from->chart_triangle, triangles, sizeof *from->chart_triangle, &ok);
    out->pages = copy(host, from->pages, from->page_count, sizeof *from->pages, &ok);
    if (!ok) charts_finish(out);
    return ok;
}
