// The passes of a frame whose light has changed.
#include "techniques/prt/prt_state.h"

static void record_rows_of(struct prt *s, struct gpu_cmd *cmd, const struct prt_tables *tables,
                           uint32_t rows)
{
    const struct prt_rows_push push = { rows };
    gpu_dispatch(cmd, s->pipelines.rows,
                 GPU_BIND(gpu_transient(cmd, "prt_light_block", &s->light, sizeof s->light),
                          { .name = "prt_transfer", .image = tables->transfer },
                          { .name = "prt_row_light", .image = tables->row_light }),
                 &push, sizeof push, gpu_groups(rows, PRT_LOCAL), 1, 1);
}

static void record_rows(struct prt *s, struct gpu_cmd *cmd)
{
    const uint32_t rows = prt_codebook_rows(&s->options);
    if (rows == 0) return;
    gpu_scope_begin(cmd, "rows");
    record_rows_of(s, cmd, &s->tables.vectors, rows);
    if (prt_is_glossy(&s->options))
        record_rows_of(s, cmd, &s->tables.matrices, PRT_OUTGOING * rows);
    gpu_scope_end(cmd);
}

// The transfer that shaders of receivers read.
#define TRANSFER_BINDINGS(state, transferred, cmd)                                                 \
    gpu_transient(cmd, "prt_light_block", &(state)->light, sizeof(state)->light),                  \
        { .name = "prt_texels", .image = (state)->tables.texels },                                 \
        { .name = "prt_transfer", .image = (transferred)->transfer },                              \
        { .name = "prt_clusters", .image = (transferred)->clusters },                              \
        { .name = "prt_weights", .image = (transferred)->weights },                                \
    {                                                                                              \
        .name = "prt_row_light", .image = (transferred)->row_light                                 \
    }

static float emitters(const struct prt *s, const struct frame_view *view)
{
    return s->options.emitters ? view->constants->radiance_scale : 0.0f;
}

static void record_light(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct prt_light_push push = { s->receivers.count, emitters(s, view) };
    gpu_scope_begin(cmd, "light");
    gpu_dispatch(cmd, s->pipelines.light,
                 GPU_BIND(TRANSFER_BINDINGS(s, &s->tables.vectors, cmd),
                          { .name = "texel_light", .image = s->tables.texel_light },
                          { .name = "vertex_light", .image = s->vertex_map.light }),
                 &push, sizeof push, gpu_groups(push.texels, PRT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

void prt_record_probes(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    prt_probes_record_gather(&s->probes, cmd, &s->light, emitters(s, view));
}

void prt_record_update(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    record_rows(s, cmd);
    record_light(s, cmd, view);
    if (!s->receivers.at_vertices)
        light_map_record_all(&s->light_map, cmd, s->tables.texel_light, s->options.seams);
}

void prt_record_reflect(struct prt *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const uint32_t texels = s->receivers.count, rows = prt_codebook_rows(&s->options);
    const struct prt_reflect_push push = { texels, rows > 0 ? rows : texels, emitters(s, view),
                                           prt_coefficients(&s->options) };
    gpu_scope_begin(cmd, "reflect");
    gpu_dispatch(cmd, s->pipelines.reflect,
                 GPU_BIND(TRANSFER_BINDINGS(s, &s->tables.matrices, cmd), view->constants_binding,
                          view->environment_binding,
                          { .name = "texel_radiance", .image = s->tables.texel_radiance }),
                 &push, sizeof push, gpu_groups(texels, PRT_LOCAL), 1, 1);
    light_map_record_reflected(&s->light_map, cmd, s->tables.texel_radiance, s->options.seams);
    gpu_scope_end(cmd);
}
