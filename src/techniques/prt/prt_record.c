// The passes of a frame whose light has changed.
#include "techniques/prt/prt_state.h"

static void record_rows(struct prt *s, struct gpu_cmd *cmd, const struct prt_light *light)
{
    const struct prt_rows_push push = { prt_codebook_rows(&s->options) };
    if (push.rows == 0) return;
    gpu_scope_begin(cmd, "rows");
    gpu_dispatch(cmd, s->pipelines.rows,
                 GPU_BIND(gpu_transient(cmd, "prt_light_block", light, sizeof *light),
                          { .name = "prt_transfer", .image = s->tables.transfer },
                          { .name = "prt_row_light", .image = s->tables.row_light }),
                 &push, sizeof push, gpu_groups(push.rows, PRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void record_light(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                         const struct prt_light *light)
{
    const struct prt_light_push push = { s->charts.side_texel_count,
                                         s->options.emitters ? view->constants->radiance_scale
                                                             : 0.0f };
    gpu_scope_begin(cmd, "light");
    gpu_dispatch(cmd, s->pipelines.light,
                 GPU_BIND(gpu_transient(cmd, "prt_light_block", light, sizeof *light),
                          { .name = "prt_texels", .image = s->tables.texels },
                          { .name = "prt_transfer", .image = s->tables.transfer },
                          { .name = "prt_clusters", .image = s->tables.clusters },
                          { .name = "prt_weights", .image = s->tables.weights },
                          { .name = "prt_row_light", .image = s->tables.row_light },
                          { .name = "texel_light", .image = s->tables.texel_light }),
                 &push, sizeof push, gpu_groups(push.texels, PRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

void prt_record_update(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view,
                       const struct prt_light *light)
{
    record_rows(s, cmd, light);
    record_light(s, cmd, view, light);
    light_map_record_all(&s->light_map, cmd, s->tables.texel_light, s->options.seams);
}
