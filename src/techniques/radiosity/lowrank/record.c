// The passes of low-rank transfer.
#include "techniques/radiosity/lowrank/lowrank.h"

void radiosity_lowrank_project(const struct radiosity_lowrank *l, struct gpu_cmd *cmd,
                               uint32_t first, uint32_t count, gpu_image radiosity)
{
    const struct radiosity_project_push push = { first };
    gpu_dispatch(cmd, l->project,
                 GPU_BIND({ .name = "radiosity_regions", .buffer = l->table },
                          { .name = "radiosity_sources", .image = l->sources },
                          { .name = "radiosity_projections", .image = l->projections },
                          { .name = "radiosity_scales", .image = l->scales },
                          { .name = "radiosity_sent", .image = radiosity },
                          { .name = "radiosity_modes", .buffer = l->modes }),
                 &push, sizeof push, count, 1, 1);
}

void radiosity_lowrank_expand(const struct radiosity_lowrank *l, struct gpu_cmd *cmd,
                              const struct frame_view *view,
                              const struct radiosity_lowrank_rows *rows)
{
    const struct radiosity_expand_push push = { rows->first, rows->count, rows->texel_count,
                                                rows->emitters ? 1.0f : 0.0f };
    gpu_dispatch(cmd, l->expand,
                 GPU_BIND(view->constants_binding,
                          { .name = "radiosity_texels", .image = rows->texels },
                          { .name = "radiosity_order", .image = l->order },
                          { .name = "radiosity_regions", .buffer = l->table },
                          { .name = "radiosity_expansions", .image = l->expansions },
                          { .name = "radiosity_modes", .buffer = l->modes },
                          { .name = "radiosity_light", .image = rows->light }),
                 &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}
