#include "techniques/ort/ort_map.h"

#include <string.h>

enum { MOST_CHARTS = 1 << 20 };

static enum charts_coordinates coordinates_of(const struct ort_options *options)
{
    static const enum charts_coordinates OF[] = { CHARTS_TEXCOORD_0_OR_1, CHARTS_TEXCOORD_0,
                                                  CHARTS_TEXCOORD_1, CHARTS_NO_TEXCOORD };
    return OF[options->coordinates];
}

bool ort_charts(const struct scene_pose *statics, const void *options, struct host *host,
                struct charts *out)
{
    const struct ort_options *o = options;
    const struct charts_wish wish = { .technique = "ort",
                                      .texels = (uint32_t)o->texels,
                                      .density = o->density,
                                      .most_charts = MOST_CHARTS,
                                      .coordinates = coordinates_of(o) };
    return charts_init_wanted(out, host, statics, &wish);
}

bool ort_map_init(struct ort_map *out, struct host *host, const struct scene_pose *pose,
                  const struct ort_options *options)
{
    *out = (struct ort_map){ .host = host };
    if (!ort_charts(pose, options, host, &out->charts)) return false;
    out->texel_count = out->charts.side_texel_count;
    out->width = out->charts.width;
    out->height = charts_sides(&out->charts) * out->charts.height;
    const size_t places = (size_t)out->width * out->height;
    out->texel_at = host_alloc(host, places, sizeof *out->texel_at);
    if (!out->texel_at) {
        ort_map_finish(out);
        return false;
    }
    memset(out->texel_at, 0xff, places * sizeof *out->texel_at);
    for (uint32_t i = 0; i < out->texel_count; i++) {
        const struct ort_place at = ort_place_of(out, i);
        out->texel_at[(size_t)at.y * out->width + at.x] = i;
    }
    return true;
}

void ort_map_finish(struct ort_map *map)
{
    if (!map->host) return;
    charts_finish(&map->charts);
    host_free(map->host, map->texel_at);
    *map = (struct ort_map){ 0 };
}
