// The passes of a frame.
#include "techniques/radiosity/radiosity_state.h"

static void record_direct(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct radiosity_direct_push push = { s->map.texel_count, view->shadow_radius,
                                                s->options.emitters ? 1.0f : 0.0f };
    gpu_dispatch(
        cmd, s->pipelines.direct,
        GPU_BIND(
            view->constants_binding, view->lights_binding, view->shadow_faces_binding,
            { .name = "shadow_maps", .image = view->shadow_maps, .sampler = view->shadow_sampler },
            { .name = "shadow_sun_maps",
              .image = view->shadow_sun_maps,
              .sampler = view->shadow_sampler },
            { .name = "radiosity_texels", .buffer = s->buffers.texels },
            { .name = "radiosity_flux", .buffer = s->buffers.flux }),
        &push, sizeof push, gpu_groups(push.texels, RADIOSITY_LOCAL), 1, 1);
}

static void record_clusters(struct radiosity *s, struct gpu_cmd *cmd)
{
    const struct radiosity_clusters_push push = { s->map.cluster_count };
    gpu_dispatch(cmd, s->pipelines.clusters,
                 GPU_BIND({ .name = "radiosity_clusters", .buffer = s->buffers.clusters },
                          { .name = "radiosity_members", .buffer = s->buffers.members },
                          { .name = "radiosity_flux", .buffer = s->buffers.flux },
                          { .name = "radiosity_sent", .buffer = s->buffers.sent }),
                 &push, sizeof push, gpu_groups(push.clusters, RADIOSITY_LOCAL), 1, 1);
}

static void record_nodes(struct radiosity *s, struct gpu_cmd *cmd, gpu_buffer radiosity)
{
    const struct radiosity_nodes_push push = { s->map.cluster_count,
                                               s->map.tree.count - s->map.cluster_count };
    gpu_dispatch(cmd, s->pipelines.nodes,
                 GPU_BIND({ .name = "radiosity_clusters", .buffer = s->buffers.clusters },
                          { .name = "radiosity_nodes", .buffer = s->buffers.nodes },
                          { .name = "radiosity_sent", .buffer = radiosity }),
                 &push, sizeof push, gpu_groups(push.nodes, RADIOSITY_LOCAL), 1, 1);
}

static void record_step_of(struct radiosity *s, struct gpu_cmd *cmd, float over, gpu_buffer last,
                           gpu_buffer next, const struct radiosity_block *block)
{
    const struct radiosity_solve_push push = { block->first, block->count,
                                               2 * (uint32_t)s->options.sources, over };
    gpu_dispatch(cmd, s->pipelines.solve,
                 GPU_BIND({ .name = "radiosity_clusters", .buffer = s->buffers.clusters },
                          { .name = "radiosity_cluster_factors",
                            .buffer = s->buffers.cluster_factors,
                            .offset = block->offset,
                            .bytes = block->bytes },
                          { .name = "radiosity_sent", .buffer = s->buffers.sent },
                          { .name = "radiosity_last", .buffer = last },
                          { .name = "radiosity_next", .buffer = next }),
                 &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static void record_step(struct radiosity *s, struct gpu_cmd *cmd, float over, gpu_buffer last,
                        gpu_buffer next)
{
    for (uint32_t first = 0; first < s->map.cluster_count;) {
        const struct radiosity_block block = radiosity_cluster_block(s, first);
        record_step_of(s, cmd, over, last, next, &block);
        first += block.count;
    }
}

// Returns the buffer with the radiosity of all bounces. The relaxation factors of the Chebyshev
// method are those of eigenvalues in ± the spectral radius σ: 1, 1/(1 − σ²/2), 1/(1 − σ²ω/4), …
static gpu_buffer record_solution(struct radiosity *s, struct gpu_cmd *cmd)
{
    const float square = s->spectral_radius * s->spectral_radius;
    gpu_buffer last = s->buffers.sent;
    float over = 1.0f;
    record_nodes(s, cmd, last);
    // The second step starts from it and the first step's result.
    gpu_copy_buffer(cmd, s->buffers.radiosity[1], 0, s->buffers.sent, 0,
                    s->map.cluster_count * sizeof(vec3s));
    for (int i = 0; i < s->options.bounces; i++) {
        if (i == 1) over = 1.0f / (1.0f - 0.5f * square);
        if (i > 1) over = 1.0f / (1.0f - 0.25f * square * over);
        record_step(s, cmd, over, last, s->buffers.radiosity[i & 1]);
        last = s->buffers.radiosity[i & 1];
        record_nodes(s, cmd, last);
    }
    return last;
}

static void record_gather_of(struct radiosity *s, struct gpu_cmd *cmd,
                             const struct frame_view *view, gpu_buffer radiosity,
                             const struct radiosity_block *block)
{
    const struct radiosity_gather_push push = { block->first, block->count,
                                                (uint32_t)s->options.sources,
                                                s->options.emitters ? 1.0f : 0.0f };
    gpu_dispatch(cmd, s->pipelines.gather,
                 GPU_BIND(view->constants_binding,
                          { .name = "radiosity_texels", .buffer = s->buffers.texels },
                          { .name = "radiosity_factors",
                            .buffer = s->buffers.factors,
                            .offset = block->offset,
                            .bytes = block->bytes },
                          { .name = "radiosity_sent", .buffer = radiosity },
                          { .name = "radiosity_light", .buffer = s->buffers.light }),
                 &push, sizeof push, gpu_groups(push.count, RADIOSITY_LOCAL), 1, 1);
}

static void record_gather(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                          gpu_buffer radiosity)
{
    for (uint32_t first = 0; first < s->map.texel_count;) {
        const struct radiosity_block block = radiosity_texel_block(s, first);
        record_gather_of(s, cmd, view, radiosity, &block);
        first += block.count;
    }
}

static void record_smooth(struct radiosity *s, struct gpu_cmd *cmd)
{
    const struct radiosity_smooth_push push = { s->map.texel_count, s->map.charts.width };
    gpu_dispatch(cmd, s->pipelines.smooth,
                 GPU_BIND({ .name = "radiosity_points", .buffer = s->buffers.points },
                          { .name = "radiosity_owners", .buffer = s->buffers.owners },
                          { .name = "radiosity_light", .buffer = s->buffers.light },
                          { .name = "radiosity_smoothed", .buffer = s->buffers.smoothed }),
                 &push, sizeof push, gpu_groups(push.texels, RADIOSITY_LOCAL), 1, 1);
}

// Of the texels whose light is shown.
static gpu_buffer shown_light(const struct radiosity *s)
{
    return s->options.smooth ? s->buffers.smoothed : s->buffers.light;
}

static void record_map(struct radiosity *s, struct gpu_cmd *cmd)
{
    const struct radiosity_map_push push = { s->map.charts.width, s->map.charts.height };
    gpu_dispatch(cmd, s->pipelines.map,
                 GPU_BIND({ .name = "radiosity_owners", .buffer = s->buffers.owners },
                          { .name = "radiosity_light", .buffer = shown_light(s) },
                          { .name = "light_map", .image = s->buffers.light_map }),
                 &push, sizeof push, gpu_groups(push.width, RADIOSITY_LOCAL_2D),
                 gpu_groups(push.height, RADIOSITY_LOCAL_2D), s->sides);
}

static void record_seams(struct radiosity *s, struct gpu_cmd *cmd)
{
    const struct radiosity_seams_push push = { s->seam_places, RADIOSITY_SEAM_ENTRIES,
                                               s->map.charts.width, s->map.charts.height };
    gpu_dispatch(cmd, s->pipelines.seams,
                 GPU_BIND({ .name = "radiosity_places", .buffer = s->buffers.places },
                          { .name = "radiosity_seam_rows", .buffer = s->buffers.seams },
                          { .name = "radiosity_light", .buffer = shown_light(s) },
                          { .name = "light_map", .image = s->buffers.light_map }),
                 &push, sizeof push, gpu_groups(push.places, RADIOSITY_LOCAL), 1, 1);
}

void radiosity_record_light(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    gpu_scope_begin(cmd, "direct");
    record_direct(s, cmd, view);
    record_clusters(s, cmd);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "bounces");
    const gpu_buffer radiosity = record_solution(s, cmd);
    gpu_scope_end(cmd);
    s->solution = radiosity;
    gpu_scope_begin(cmd, "gather");
    record_gather(s, cmd, view, radiosity);
    gpu_scope_end(cmd);
    if (s->options.smooth) {
        gpu_scope_begin(cmd, "smooth");
        record_smooth(s, cmd);
        gpu_scope_end(cmd);
    }
    gpu_scope_begin(cmd, "light_map");
    record_map(s, cmd);
    gpu_scope_end(cmd);
    if (!s->options.seams || s->seam_places == 0) return;
    gpu_scope_begin(cmd, "seams");
    record_seams(s, cmd);
    gpu_scope_end(cmd);
}

void radiosity_record_apply(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const gpu_image *layers = view->layers;
    const gpu_image dielectric = layers[FRAME_DIELECTRIC];
    const struct radiosity_apply_push push = { s->map.charts.width, s->map.charts.height,
                                               s->instances, dielectric.id != 0 };
    gpu_scope_begin(cmd, "apply");
    gpu_dispatch(
        cmd, s->pipelines.apply,
        GPU_BIND(
            view->constants_binding, view->ggx_albedo_binding,
            { .name = "depth", .image = layers[FRAME_DEPTH] },
            { .name = "normal", .image = layers[FRAME_NORMAL] },
            { .name = "albedo", .image = layers[FRAME_ALBEDO] },
            { .name = "material", .image = layers[FRAME_MATERIAL] },
            { .name = "dielectric", .image = dielectric.id ? dielectric : layers[FRAME_MATERIAL] },
            { .name = "id", .image = layers[FRAME_ID] },
            { .name = "radiosity_instances", .buffer = s->buffers.instances },
            { .name = "radiosity_triangles", .buffer = s->buffers.triangles },
            { .name = "light_map", .image = s->buffers.light_map, .sampler = s->linear },
            { .name = "irradiance", .image = layers[FRAME_IRRADIANCE] },
            { .name = "specular", .image = layers[FRAME_SPECULAR] }),
        &push, sizeof push, gpu_groups(view->width, RADIOSITY_LOCAL_2D),
        gpu_groups(view->height, RADIOSITY_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
