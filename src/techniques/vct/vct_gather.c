// Cones of the pixels, and the gathering of what neighbours have traced.
#include "techniques/vct/vct_state.h"

// Parts of a block that trace cone `cone`, see vct_cones.glsl. A cone that several trace counts
// once.
static int parts_with(uint32_t cone, uint32_t parts, uint32_t cones)
{
    int count = 0;
    for (uint32_t part = 0; part < parts; part++)
        for (uint32_t i = part * 7 % parts % cones; i < cones; i += parts) count += i == cone;
    return count;
}

struct vct_cone_params vct_cone_params(const struct vct *vct, const struct frame_view *view,
                                       int choice, uint32_t side)
{
    const struct vct_options *options = &vct->options;
    const uint32_t count = (uint32_t)vct_cone_count(choice);
    struct vct_cone_params params = {
        .cone_count = count,
        .interleave = side,
        .width = view->width,
        .height = view->height,
        .sub_width = gpu_groups(view->width, side),
        .sub_height = gpu_groups(view->height, side),
        .width_per_m = options->stride * vct_cone_width(choice),
        .offset = options->offset,
        .gain = options->gain,
        .texel_m = 2.0f * vct->grid.cell_m,
        .last_mip = vct_volume_mips(options) - 1,
    };
    struct vct_cone cones[VCT_MAX_CONES];
    vct_cone_set(choice, cones);
    for (uint32_t i = 0; i < count; i++) {
        const vec3s d = cones[i].direction;
        const float weight = cones[i].weight / (float)parts_with(i, side * side, count);
        params.cones[i] = (vec4s){ { d.x, d.y, d.z, weight } };
    }
    return params;
}

void vct_record_cones(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const bool temporal = vct->options.temporal;
    struct vct_cone_params params =
        vct_cone_params(vct, view, vct->options.cones, (uint32_t)vct->options.interleave);
    if (temporal) vct_temporal_turn(&vct->temporal, vct->options.cones, &params);
    const gpu_image result = temporal ? vct->temporal.now : view->layers[FRAME_IRRADIANCE];
    const struct gpu_binding cones = gpu_transient(cmd, "vct_cones", &params, sizeof params);
    const struct gpu_binding depth = { .name = "depth", .image = view->layers[FRAME_DEPTH] };
    const struct gpu_binding normal = { .name = "normal", .image = view->layers[FRAME_NORMAL] };
    const uint32_t across = gpu_groups(view->width, VCT_LOCAL_2D),
                   down = gpu_groups(view->height, VCT_LOCAL_2D);
    const struct gpu_binding edges = { .name = "edges", .image = vct->edge_image };

    gpu_scope_begin(cmd, "vct.cones");
    gpu_dispatch(cmd, vct->cones,
                 GPU_BIND(vct_grid_binding(vct, cmd), view->constants_binding, cones, depth, normal,
                          { .name = "light", .image = vct->light, .sampler = vct->linear },
                          { .name = "gathered", .image = vct->traced }, vct_svo_binding(vct, cmd),
                          { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
                 NULL, 0, gpu_groups(params.sub_width, VCT_LOCAL_2D),
                 gpu_groups(params.sub_height, VCT_LOCAL_2D),
                 params.interleave * params.interleave);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "vct.edges");
    gpu_dispatch(cmd, vct->edges, GPU_BIND(view->constants_binding, cones, depth, normal, edges),
                 NULL, 0, across, down, 1);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "vct.gather");
    gpu_dispatch(cmd, vct->gather_rows,
                 GPU_BIND(cones, edges, { .name = "gathered", .image = vct->traced },
                          { .name = "result", .image = vct->gathered }),
                 NULL, 0, across, down, 1);
    gpu_dispatch(cmd, vct->gather_columns,
                 GPU_BIND(cones, edges, { .name = "gathered", .image = vct->gathered },
                          { .name = "result", .image = result }),
                 NULL, 0, across, down, 1);
    gpu_scope_end(cmd);
}

void vct_record_debug(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out)
{
    // Reflectance and normals are shown as bright as a surface in the strongest light is.
    const struct vct_view_push push = { .view = what, .reflectance_shown = 4.0f };
    gpu_scope_begin(cmd, "vct.debug");
    gpu_dispatch(cmd, vct->debug,
                 GPU_BIND(vct_grid_binding(vct, cmd), view->constants_binding,
                          { .name = "static_mask", .buffer = vct->rest.mask },
                          { .name = "static_before", .buffer = vct->rest.before },
                          { .name = "static_records", .image = vct->rest.records },
                          { .name = "dynamic_mask", .buffer = vct->moving.mask },
                          { .name = "dynamic_before", .buffer = vct->moving.before },
                          { .name = "dynamic_records", .image = vct->moving.records },
                          { .name = "picture", .image = out }, vct_svo_binding(vct, cmd),
                          { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
                 &push, sizeof push, gpu_groups(view->width, VCT_LOCAL_2D),
                 gpu_groups(view->height, VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}
