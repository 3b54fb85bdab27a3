// Debug views: a label for each texel, and the pass that shows them.
#include "techniques/radiosity/radiosity_state.h"

#include <string.h>

const struct technique_debug_view radiosity_views[] = {
    { "charts", "a colour for each chart of the light map", NULL },
    { "clusters", "a colour for each cluster, a source of bounced light", NULL },
    { "validity", "texels inside geometry: yellow sampled beside it, red filled, violet black",
      NULL },
    { LIGHT_MAP_TEXELS_VIEW, LIGHT_MAP_TEXELS_VIEW_HELP, NULL },
    { PROBES_VIEW, PROBES_VIEW_HELP, NULL },
    { NULL, NULL, NULL },
};

static uint32_t state_of(const struct chart_texel *texel, const float point[4])
{
    if (!(point[3] > 0.0f)) return RADIOSITY_NOT_SAMPLED;
    return memcmp(texel->position.raw, point, sizeof texel->position.raw) == 0
               ? RADIOSITY_SAMPLED_IN_MIDDLE
               : RADIOSITY_SAMPLED_BESIDE;
}

static struct radiosity_gpu_label label_of(const struct radiosity *s, const float *points,
                                           uint32_t owner, size_t place)
{
    const struct charts *charts = &s->map.charts;
    const struct chart_texel *t = chart_texel_of(charts, owner);
    const size_t row = (chart_is_back(charts, owner) ? charts->height : 0) + t->y;
    const uint32_t state = state_of(t, points + 4 * (size_t)owner);
    const bool filled = state != RADIOSITY_NOT_SAMPLED && row * charts->width + t->x != place;
    return (struct radiosity_gpu_label){ .chart = charts->triangles[t->triangle].chart,
                                         .cluster = s->map.cluster_of[owner],
                                         .state = filled ? RADIOSITY_FILLED : state };
}

bool radiosity_view_init(struct radiosity *s, const float *points, const uint32_t *nearest_valid)
{
    const size_t places = charts_place_count(&s->map.charts);
    struct radiosity_gpu_label *labels = host_alloc(s->host, places, sizeof *labels);
    for (size_t i = 0; labels && i < places; i++) {
        const uint32_t texel = chart_texel_of_place(&s->map.charts, i);
        labels[i] = texel == CHART_NONE
                        ? (struct radiosity_gpu_label){ .state = RADIOSITY_NO_TEXEL }
                        : label_of(s, points, nearest_valid[texel], i);
    }
    return light_map_buffer_upload(s->host, s->gpu, "labels", labels, places * sizeof *labels,
                                   &s->tables.labels);
}

static uint32_t number_of(const char *name)
{
    uint32_t view = 0; // RADIOSITY_VIEW_… are in the order of the names
    while (strcmp(radiosity_views[view].name, name) != 0) view++;
    return view;
}

void radiosity_view_record(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                           const char *name, gpu_image out)
{
    const gpu_image *layers = view->layers;
    if (strcmp(name, LIGHT_MAP_TEXELS_VIEW) == 0) {
        light_map_record_texels_view(&s->light_map, cmd, view, out);
        return;
    }
    const struct radiosity_view_push push = { light_map_instances(&s->light_map.surfaces),
                                              s->map.charts.width, s->map.charts.height,
                                              number_of(name) };
    gpu_scope_begin(cmd, "view");
    gpu_dispatch(cmd, s->pipelines.view,
                 GPU_BIND(view->constants_binding,
                          { .name = "depth", .image = layers[FRAME_DEPTH] },
                          { .name = "normal", .image = layers[FRAME_NORMAL] },
                          { .name = "id", .image = layers[FRAME_ID] },
                          LIGHT_MAP_SURFACE_BINDINGS(&s->light_map.surfaces, cmd),
                          { .name = "radiosity_labels", .buffer = s->tables.labels },
                          { .name = "target", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, RADIOSITY_LOCAL_2D),
                 gpu_groups(view->height, RADIOSITY_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
