// The passes of a frame whose light has changed.
#include "techniques/ort/ort_state.h"

static void record_direct(struct ort *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct ort_direct_push push = { s->map.texel_count, view->shadow_radius,
                                          light_map_sources(&s->paint, view, s->options.emitters) };
    gpu_scope_begin(cmd, "direct");
    gpu_dispatch(
        cmd, s->pipelines.direct,
        GPU_BIND(FRAME_LIGHT_BINDINGS(view),
                 LIGHT_MAP_TEXEL_BINDINGS(view, &s->paint, s->tables.texels, s->tables.sky),
                 { .name = "ort_places", .image = s->tables.places },
                 { .name = "first_order", .image = s->tables.first_order }),
        &push, sizeof push, gpu_groups(push.texels, ORT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

static void record_spread(struct ort *s, struct gpu_cmd *cmd)
{
    const struct ort_spread_push push = { s->map.width, s->map.height };
    gpu_scope_begin(cmd, "spread");
    gpu_dispatch(cmd, s->pipelines.spread,
                 GPU_BIND({ .name = "first_order", .image = s->tables.first_order },
                          { .name = "ort_light", .image = s->tables.light }),
                 &push, sizeof push, gpu_groups(push.height, ORT_LOCAL),
                 push.width + 2 * ORT_MARGIN, 1);
    gpu_scope_end(cmd);
}

static void record_prefilter(struct ort *s, struct gpu_cmd *cmd)
{
    struct ort_level_push push = { s->map.width, s->map.height, 1, 1 };
    const uint32_t groups = gpu_groups(push.height, ORT_LOCAL);
    if (s->levels == 1) return;
    gpu_scope_begin(cmd, "prefilter");
    for (; push.level < (int32_t)s->levels; push.level++, push.stride *= 3) {
        gpu_dispatch(cmd, s->pipelines.prefilter_x,
                     GPU_BIND({ .name = "ort_steps", .image = s->tables.steps },
                              { .name = "ort_light", .image = s->tables.light },
                              { .name = "ort_filtered", .image = s->tables.filtered }),
                     &push, sizeof push, groups, push.width, 1);
        gpu_dispatch(cmd, s->pipelines.prefilter_y,
                     GPU_BIND({ .name = "ort_steps", .image = s->tables.steps },
                              { .name = "ort_filtered", .image = s->tables.filtered },
                              { .name = "ort_light", .image = s->tables.light }),
                     &push, sizeof push, groups, push.width + 2 * ORT_MARGIN, 1);
    }
    gpu_scope_end(cmd);
}

void ort_record_levels(struct ort *s, struct gpu_cmd *cmd)
{
    record_spread(s, cmd);
    record_prefilter(s, cmd);
}

static void record_gather(struct ort *s, struct gpu_cmd *cmd)
{
    const uint32_t columns = ort_columns(&s->map), blocks = ort_blocks(s);
    gpu_scope_begin(cmd, "gather");
    for (uint32_t part = 0; part < (uint32_t)s->options.parts; part++) {
        const struct ort_gather_push push = { s->map.width, s->map.height, part * columns * blocks,
                                              part > 0 };
        gpu_dispatch(cmd, s->pipelines.gather,
                     GPU_BIND({ .name = "ort_lists", .image = s->tables.lists },
                              { .name = "ort_entries", .image = s->tables.entries },
                              { .name = "ort_bins", .image = s->tables.bins },
                              { .name = "ort_light", .image = s->tables.light },
                              { .name = "ort_sums", .image = s->tables.sums }),
                     &push, sizeof push, blocks, columns, 1);
    }
    gpu_scope_end(cmd);
}

static void record_finish(struct ort *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct ort_finish_push push = { s->map.texel_count, s->map.height,
                                          light_map_sources(&s->paint, view, s->options.emitters) };
    gpu_scope_begin(cmd, "finish");
    gpu_dispatch(
        cmd, s->pipelines.finish,
        GPU_BIND(view->constants_binding,
                 LIGHT_MAP_TEXEL_BINDINGS(view, &s->paint, s->tables.texels, s->tables.sky),
                 { .name = "ort_places", .image = s->tables.places },
                 { .name = "ort_sums", .image = s->tables.sums },
                 { .name = "texel_light", .image = s->tables.texel_light }),
        &push, sizeof push, gpu_groups(push.texels, ORT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}

void ort_record_update(struct ort *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    record_direct(s, cmd, view);
    ort_record_levels(s, cmd);
    record_gather(s, cmd);
    record_finish(s, cmd, view);
    light_map_record_all(&s->light_map, cmd, s->tables.texel_light, s->options.seams);
}

static void record_replace(struct ort *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    enum { LOCAL_2D = 8 };
    gpu_scope_begin(cmd, "replace");
    gpu_dispatch(
        cmd, s->pipelines.replace,
        GPU_BIND(view->constants_binding,
                 { .name = "direct_irradiance", .image = view->layers[FRAME_DIRECT_IRRADIANCE] },
                 { .name = "irradiance", .image = view->layers[FRAME_IRRADIANCE] }),
        NULL, 0, gpu_groups(view->width, LOCAL_2D), gpu_groups(view->height, LOCAL_2D), 1);
    gpu_scope_end(cmd);
}

void ort_record_apply(struct ort *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    light_map_record_apply(&s->light_map, cmd, view);
    if (s->options.transfer != ORT_RADIOSITY) record_replace(s, cmd, view);
}
