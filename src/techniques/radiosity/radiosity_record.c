// The passes of a frame.
#include "techniques/radiosity/radiosity_state.h"

// Rows of a stage.
struct span {
    uint32_t first, count;
};

static void record_direct(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                          struct span rows)
{
    const struct radiosity_direct_push push = {
        rows.first, rows.count, s->map.texel_count, view->shadow_radius,
        light_map_sources(&s->paint, view, s->options.emitters)
    };
    gpu_dispatch(
        cmd, s->pipelines.direct,
        GPU_BIND(FRAME_LIGHT_BINDINGS(view),
                 LIGHT_MAP_TEXEL_BINDINGS(view, &s->paint, s->tables.texels, s->tables.sky),
                 { .name = "radiosity_flux", .image = s->tables.flux }),
        &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static void record_clusters(struct radiosity *s, struct gpu_cmd *cmd)
{
    const struct radiosity_clusters_push push = { s->map.cluster_count };
    gpu_dispatch(cmd, s->pipelines.clusters,
                 GPU_BIND({ .name = "radiosity_clusters", .image = s->tables.clusters },
                          { .name = "radiosity_spans", .image = s->tables.spans },
                          { .name = "radiosity_members", .image = s->tables.members },
                          { .name = "radiosity_flux", .image = s->tables.flux },
                          { .name = "radiosity_sent", .image = s->tables.sent }),
                 &push, sizeof push, gpu_groups(push.clusters, RADIOSITY_LOCAL), 1, 1);
}

static void record_nodes(struct radiosity *s, struct gpu_cmd *cmd, gpu_image radiosity)
{
    const struct radiosity_nodes_push push = { s->group_count };
    if (push.groups == 0) return;
    gpu_dispatch(cmd, s->pipelines.nodes,
                 GPU_BIND({ .name = "radiosity_groups", .image = s->tables.groups },
                          { .name = "radiosity_clusters", .image = s->tables.clusters },
                          { .name = "radiosity_sent", .image = radiosity }),
                 &push, sizeof push, gpu_groups(push.groups, RADIOSITY_LOCAL), 1, 1);
}

// The part of some rows that is in a block.
static struct span rows_in(const struct radiosity_block *block, struct span rows)
{
    const uint32_t first = rows.first > block->first ? rows.first : block->first;
    const uint32_t end = rows.first + rows.count, block_end = block->first + block->count;
    const uint32_t last = end < block_end ? end : block_end;
    return (struct span){ first, last > first ? last - first : 0 };
}

static void record_step_of(struct radiosity *s, struct gpu_cmd *cmd, float over, gpu_image last,
                           gpu_image next, const struct radiosity_block *block, struct span rows)
{
    const struct radiosity_solve_push push = { rows.first, rows.count, over };
    gpu_dispatch(cmd, s->pipelines.solve,
                 GPU_BIND({ .name = "radiosity_clusters", .image = s->tables.clusters },
                          { .name = "radiosity_order", .image = s->tables.cluster_factors.order },
                          { .name = "radiosity_tiles", .image = s->tables.cluster_factors.tiles },
                          { .name = "radiosity_factors", .image = block->table },
                          { .name = "radiosity_sent", .image = s->tables.sent },
                          { .name = "radiosity_last", .image = last },
                          { .name = "radiosity_next", .image = next }),
                 &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static gpu_image after_step(const struct radiosity *s, int step)
{
    return step < 0 ? s->tables.sent : s->tables.radiosity[step & 1];
}

// The relaxation factors of the Chebyshev method are those of eigenvalues in ± the spectral radius
// σ: 1, 1/(1 − σ²/2), 1/(1 − σ²ω/4), …
static float over_of(const struct radiosity *s, int step)
{
    const float square = s->spectral_radius * s->spectral_radius;
    float over = 1.0f;
    for (int i = 1; i <= step; i++) over = 1.0f / (1.0f - (i == 1 ? 0.5f : 0.25f * over) * square);
    return over;
}

static void record_step(struct radiosity *s, struct gpu_cmd *cmd, int step, struct span rows)
{
    const struct radiosity_rows *all = &s->tables.cluster_factors;
    for (uint32_t i = 0; i < all->count; i++) {
        const struct span part = rows_in(&all->blocks[i], rows);
        if (part.count > 0)
            record_step_of(s, cmd, over_of(s, step), after_step(s, step - 1), after_step(s, step),
                           &all->blocks[i], part);
    }
}

static void record_strata_of(struct radiosity *s, struct gpu_cmd *cmd,
                             const struct radiosity_block *block, struct span rows)
{
    const struct radiosity_strata_push push = { rows.first, rows.count };
    gpu_dispatch(cmd, s->pipelines.strata,
                 GPU_BIND({ .name = "radiosity_order", .image = s->tables.shares.order },
                          { .name = "radiosity_tiles", .image = s->tables.shares.tiles },
                          { .name = "radiosity_factors", .image = block->table },
                          { .name = "radiosity_sent", .image = s->tables.solution },
                          { .name = "radiosity_strata", .image = s->tables.strata }),
                 &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static void record_strata(struct radiosity *s, struct gpu_cmd *cmd, struct span rows)
{
    const struct radiosity_rows *all = &s->tables.shares;
    for (uint32_t i = 0; i < all->count; i++) {
        const struct span part = rows_in(&all->blocks[i], rows);
        if (part.count > 0) record_strata_of(s, cmd, &all->blocks[i], part);
    }
}

static void record_gather_of(struct radiosity *s, struct gpu_cmd *cmd,
                             const struct frame_view *view, const struct radiosity_block *block,
                             struct span rows)
{
    const struct radiosity_gather_push push = {
        rows.first, rows.count, s->map.texel_count, s->options.smooth ? 0.0f : 1.0f,
        light_map_sources(&s->paint, view, s->options.emitters)
    };
    gpu_dispatch(
        cmd, s->pipelines.gather,
        GPU_BIND(view->constants_binding,
                 LIGHT_MAP_TEXEL_BINDINGS(view, &s->paint, s->tables.texels, s->tables.sky),
                 { .name = "radiosity_order", .image = s->tables.factors.order },
                 { .name = "radiosity_tiles", .image = s->tables.factors.tiles },
                 { .name = "radiosity_factors", .image = block->table },
                 { .name = "radiosity_strata", .image = s->tables.strata },
                 { .name = "texel_light", .image = s->tables.light },
                 { .name = "texel_fluence", .image = s->tables.fluence }),
        &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static void record_gather(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                          struct span rows)
{
    const struct radiosity_rows *all = &s->tables.factors;
    for (uint32_t i = 0; i < all->count; i++) {
        const struct span part = rows_in(&all->blocks[i], rows);
        if (part.count > 0) record_gather_of(s, cmd, view, &all->blocks[i], part);
    }
}

static void record_smooth(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                          struct span rows, uint32_t pass)
{
    const struct radiosity_smooth_push push = {
        rows.first, rows.count,  s->map.texel_count,
        pass,       (float)pass, light_map_sources(&s->paint, view, s->options.emitters)
    };
    const gpu_image light[2] = { s->tables.light, s->tables.smoothed };
    const gpu_image fluence[2] = { s->tables.fluence, s->tables.smoothed_fluence };
    gpu_dispatch(
        cmd, s->pipelines.smooth,
        GPU_BIND(view->constants_binding,
                 LIGHT_MAP_TEXEL_BINDINGS(view, &s->paint, s->tables.texels, s->tables.sky),
                 { .name = "radiosity_neighbours", .image = s->tables.neighbours },
                 { .name = "texel_light", .image = light[pass] },
                 { .name = "texel_fluence", .image = fluence[pass] },
                 { .name = "radiosity_smoothed", .image = light[1 - pass] },
                 { .name = "radiosity_smoothed_fluence", .image = fluence[1 - pass] }),
        &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

uint32_t radiosity_stage_rows(const struct radiosity *s, enum radiosity_stage stage)
{
    switch (stage) {
    case RADIOSITY_DIRECT:
    case RADIOSITY_GATHER:
        return s->map.texel_count;
    case RADIOSITY_BOUNCES:
        return s->map.cluster_count;
    case RADIOSITY_STRATA:
        return s->stratum_count;
    case RADIOSITY_SMOOTH:
    case RADIOSITY_SMOOTH_WIDE:
        return s->options.smooth ? s->map.texel_count : 0;
    case RADIOSITY_LIGHT_MAP:
        return s->light_map.owner_count;
    case RADIOSITY_SEAMS:
        return s->options.seams ? s->light_map.seam_count : 0;
    default:
        return 0;
    }
}

const char *radiosity_stage_name(enum radiosity_stage stage)
{
    static const char *const names[] = { "direct", "bounces",     "strata",    "gather",
                                         "smooth", "smooth_wide", "light_map", "seams" };
    return names[stage];
}

static void record_rows(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                        const struct radiosity_part *part)
{
    const struct span rows = { part->first, part->count };
    const struct light_map_tables tables = { s->tables.light, s->tables.fluence };
    switch (part->stage) {
    case RADIOSITY_DIRECT:
        record_direct(s, cmd, view, rows);
        break;
    case RADIOSITY_BOUNCES:
        record_step(s, cmd, part->step, rows);
        break;
    case RADIOSITY_STRATA:
        record_strata(s, cmd, rows);
        break;
    case RADIOSITY_GATHER:
        record_gather(s, cmd, view, rows);
        break;
    case RADIOSITY_SMOOTH:
        record_smooth(s, cmd, view, rows, 0);
        break;
    case RADIOSITY_SMOOTH_WIDE:
        record_smooth(s, cmd, view, rows, 1);
        break;
    case RADIOSITY_LIGHT_MAP:
        light_map_record_show(&s->light_map, cmd, tables, rows.first, rows.count);
        break;
    default:
        light_map_record_seams(&s->light_map, cmd, tables, rows.first, rows.count);
    }
}

// Records the passes that follow the last row of a stage.
static void record_end(struct radiosity *s, struct gpu_cmd *cmd, const struct radiosity_part *part)
{
    if (part->stage == RADIOSITY_DIRECT) {
        record_clusters(s, cmd);
        record_nodes(s, cmd, s->tables.sent);
        // The second step starts from it and the first step's result.
        gpu_copy_image(cmd, s->tables.radiosity[1], s->tables.sent);
        if (part->steps == 0) gpu_copy_image(cmd, s->tables.solution, s->tables.sent);
    }
    if (part->stage != RADIOSITY_BOUNCES) return;
    record_nodes(s, cmd, after_step(s, part->step));
    if (part->step + 1 == part->steps)
        gpu_copy_image(cmd, s->tables.solution, after_step(s, part->step));
}

void radiosity_record_part(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                           const struct radiosity_part *part)
{
    if (part->count > 0) record_rows(s, cmd, view, part);
    if (part->first + part->count == radiosity_stage_rows(s, part->stage)) record_end(s, cmd, part);
}
