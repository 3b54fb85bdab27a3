// Debug views: a label for each texel, and the pass that shows them.
#include "techniques/radiosity/radiosity_state.h"

#include <string.h>

#include "technique_shaders.h"

const struct technique_debug_view radiosity_views[] = {
    { "charts", "a colour for each chart of the light map", NULL },
    { "texels", "a checkerboard of the light map's texels", NULL },
    { "clusters", "a colour for each cluster, a source of bounced light", NULL },
    { "validity", "texels inside of something: yellow sampled beside it, red filled, violet black",
      NULL },
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

bool radiosity_view_init(struct radiosity *s, const float *points)
{
    const struct charts *charts = &s->map.charts;
    struct radiosity_gpu_label *labels = host_alloc(s->host, s->map.texel_count, sizeof *labels);
    const size_t bytes = s->map.texel_count * sizeof *labels;
    const struct gpu_buffer_desc desc = { "labels", bytes, GPU_BUFFER_STORAGE };
    for (uint32_t i = 0; labels && i < s->map.texel_count; i++) {
        const struct radiosity_texel *texel = &s->map.texels[i];
        const struct chart_texel *t = &charts->texels[texel->chart_texel];
        const uint32_t row = (texel->back ? charts->height : 0) + t->y;
        labels[i] = (struct radiosity_gpu_label){ .place = row * charts->width + t->x,
                                                  .chart = charts->triangles[t->triangle].chart,
                                                  .cluster = texel->cluster,
                                                  .state = state_of(t, points + 4 * (size_t)i) };
    }
    const bool ok = labels && gpu_buffer_create(s->gpu, &desc, &s->buffers.labels) &&
                    gpu_buffer_upload(s->gpu, s->buffers.labels, 0, labels, bytes) &&
                    gpu_compute_pipeline_create(s->gpu, "view", &shader_radiosity_view_comp, NULL,
                                                0, &s->pipelines.view);
    host_free(s->host, labels);
    return ok;
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
    const struct radiosity_view_push push = { s->map.charts.width, s->map.charts.height,
                                              s->instances, number_of(name) };
    gpu_scope_begin(cmd, "view");
    gpu_dispatch(cmd, s->pipelines.view,
                 GPU_BIND(view->constants_binding,
                          { .name = "depth", .image = layers[FRAME_DEPTH] },
                          { .name = "normal", .image = layers[FRAME_NORMAL] },
                          { .name = "id", .image = layers[FRAME_ID] },
                          { .name = "radiosity_instances", .buffer = s->buffers.instances },
                          { .name = "radiosity_triangles", .buffer = s->buffers.triangles },
                          { .name = "radiosity_owners", .buffer = s->buffers.owners },
                          { .name = "radiosity_labels", .buffer = s->buffers.labels },
                          { .name = "target", .image = out }),
                 &push, sizeof push, gpu_groups(view->width, RADIOSITY_LOCAL_2D),
                 gpu_groups(view->height, RADIOSITY_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
