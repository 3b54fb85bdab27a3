#include "techniques/vct/cones/cones.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

#include <math.h>

// Number of pixels in a block that trace `cone`: see cones/cones.comp.
static int pixels_tracing(uint32_t cone, uint32_t parts, uint32_t cones)
{
    int count = 0;
    for (uint32_t part = 0; part < parts; part++)
        for (uint32_t i = part * 7 % parts % cones; i < cones; i += parts) count += i == cone;
    return count;
}

// Columns of the grid of strata: rows · columns = cones.
static uint32_t columns_of(uint32_t cones)
{
    uint32_t columns = (uint32_t)sqrtf((float)cones);
    while (cones % columns != 0) columns--;
    return columns;
}

static struct vct_cone_params params_of(const struct vct *vct, const struct frame_view *view,
                                        int choice, uint32_t side)
{
    const struct vct_options *options = &vct->options;
    return (struct vct_cone_params){
        .cone_count = (uint32_t)vct_cone_count(choice),
        .interleave = side,
        .step = 1,
        .width = view->width,
        .height = view->height,
        .width_per_m = options->step_size * vct_cone_width(choice),
        .offset = options->offset,
        .gain = options->gain,
        .columns = columns_of((uint32_t)vct_cone_count(choice)),
        .texel_m = 2.0f * vct->clips[vct->clip_count - 1].grid.cell_m,
        .last_mip = vct_volume_mips(options) - 1,
        .environment_sigma = 0.5f * atanf(0.5f * vct_cone_width(choice)),
    };
}

struct vct_cone_params vct_voxel_cones(const struct vct *vct, const struct frame_view *view)
{
    const int choice = vct_has_rays(&vct->options) ? VCT_CONES_9 : VCT_CONES_6;
    struct vct_cone_params params = params_of(vct, view, choice, 1);
    // Wide samples mix both sides of a wall, and each bounce adds to the leak.
    params.width_per_m = vct->options.step_size * vct_cone_width(VCT_CONES_25);
    struct vct_cone cones[VCT_MAX_CONES];
    vct_cone_set(choice, cones);
    for (uint32_t i = 0; i < params.cone_count; i++)
        params.cones[i] = vec4_of(cones[i].direction, cones[i].weight);
    return params;
}

// World-space axes. Each cone's weight, 1/count, is divided among the pixels of a block that trace
// it.
static struct vct_cone_params pixel_cones(const struct vct *vct, const struct frame_view *view)
{
    const uint32_t side = (uint32_t)vct->options.interleave;
    struct vct_cone_params params = params_of(vct, view, vct->options.cones, side);
    const uint32_t count = params.cone_count;
    params.step = vct_step(&vct->options);
    params.width = vct->pixels->width;
    params.height = vct->pixels->height;
    for (uint32_t i = 0; i < count; i++)
        params.cones[i] =
            vec4_of(vct->cone_axes[i],
                    1.0f / (float)(count * (uint32_t)pixels_tracing(i, side * side, count)));
    vct_stratum_axes(vct->options.temporal ? vct->temporal->number : 0, params.set_axes);
    return params;
}

// Bindings that the per-pixel passes share.
struct pixels {
    struct gpu_binding clipmap, cones, depth, normal, edges, cone_normal;
    uint32_t across, down; // workgroups, one invocation per traced pixel
};

static void trace_cones(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                        const struct pixels *p, gpu_image result)
{
    const uint32_t side = (uint32_t)vct->options.interleave; // of a block
    gpu_scope_begin(cmd, "cones");
    gpu_dispatch(
        cmd, vct->cones[vct_light_variant(vct, view)],
        GPU_BIND(vct_grid_binding(vct, &vct->clips[0], cmd), p->clipmap, view->constants_binding,
                 view->environment_binding, p->cones, p->depth, p->normal, p->cone_normal,
                 { .name = "light", .image = vct->light, .sampler = vct->linear },
                 { .name = "red", .image = vct->pixels->traced[0] },
                 { .name = "green", .image = vct->pixels->traced[1] },
                 { .name = "blue", .image = vct->pixels->traced[2] },
                 { .name = "irradiance", .image = result }, VCT_RAY_BINDINGS(vct, &vct->clips[0]),
                 vct_small_emitters_binding(vct, cmd), vct_svo_binding(vct, cmd),
                 { .name = "vct_svo_nodes", .buffer = vct->svo.nodes }),
        NULL, 0, side * side * gpu_groups(gpu_groups(vct->pixels->width, side), VCT_LOCAL_2D),
        gpu_groups(gpu_groups(vct->pixels->height, side), VCT_LOCAL_2D), 1);
    gpu_scope_end(cmd);
}

static void gather(struct vct *vct, struct gpu_cmd *cmd, const struct pixels *p,
                   gpu_pipeline pipeline, gpu_image from[3], gpu_image to[3], uint32_t across,
                   uint32_t down)
{
    gpu_dispatch(
        cmd, pipeline,
        GPU_BIND(p->cones, p->normal, p->edges, { .name = "red", .image = from[0] },
                 { .name = "green", .image = from[1] }, { .name = "blue", .image = from[2] },
                 { .name = "red_sum", .image = to[0] }, { .name = "green_sum", .image = to[1] },
                 { .name = "blue_sum", .image = to[2] },
                 { .name = "irradiance", .image = vct->pixels->gathered_irradiance }),
        NULL, 0, across, down, 1);
}

static void find_edges(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                       const struct pixels *p)
{
    gpu_scope_begin(cmd, "edges");
    gpu_dispatch(cmd, vct->edges,
                 GPU_BIND(view->constants_binding, p->clipmap, p->cones, p->depth, p->normal,
                          p->edges, p->cone_normal),
                 NULL, 0, p->across, p->down, 1);
    gpu_scope_end(cmd);
}

static void gather_cones(struct vct *vct, struct gpu_cmd *cmd, const struct pixels *p)
{
    const int largest = vct->options.interleave == VCT_MAX_INTERLEAVE;
    gpu_scope_begin(cmd, "gather");
    gather(vct, cmd, p, vct->gather_rows[largest], vct->pixels->traced, vct->pixels->gathered,
           gpu_groups(vct->pixels->width, VCT_LOCAL_2D * VCT_GATHER_ROW), p->down);
    gather(vct, cmd, p, vct->gather_columns[largest], vct->pixels->gathered, vct->pixels->traced,
           p->across, gpu_groups(vct->pixels->height, VCT_LOCAL_2D * VCT_GATHER_ROW));
    gpu_scope_end(cmd);
}

// For pixels that gathered only a small fraction of the cone set.
static void blur(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                 const struct pixels *p, gpu_image result)
{
    gpu_scope_begin(cmd, "blur");
    gpu_dispatch(cmd, vct->blur,
                 GPU_BIND(view->constants_binding, p->clipmap, p->cones, p->depth, p->normal,
                          { .name = "gathered", .image = vct->pixels->gathered_irradiance },
                          { .name = "irradiance", .image = result }),
                 NULL, 0, gpu_groups(p->across, VCT_BLUR_TILE), gpu_groups(p->down, VCT_BLUR_TILE),
                 1);
    gpu_scope_end(cmd);
}

// From half resolution to full resolution.
static void upsample(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                     const struct pixels *p, gpu_image result)
{
    gpu_scope_begin(cmd, "upsample");
    gpu_dispatch(cmd, vct->upsample,
                 GPU_BIND(view->constants_binding, p->clipmap, p->cones, p->depth, p->normal,
                          p->cone_normal, { .name = "red", .image = vct->pixels->traced[0] },
                          { .name = "green", .image = vct->pixels->traced[1] },
                          { .name = "blue", .image = vct->pixels->traced[2] },
                          { .name = "irradiance", .image = result }),
                 NULL, 0, p->across, p->down, 1);
    gpu_scope_end(cmd);
}

void vct_record_cones(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const bool temporal = vct->options.temporal;
    struct vct_cone_params params = pixel_cones(vct, view);
    if (temporal) vct_temporal_rotate_cones(vct->temporal, &params);
    const gpu_image result = temporal ? vct_temporal_now(vct->temporal) : vct_result(vct, view);
    const struct pixels p = { .clipmap = vct_clipmap_binding(vct, cmd),
                              .cones = gpu_transient(cmd, "vct_cones", &params, sizeof params),
                              .depth = { .name = "depth", .image = view->layers[FRAME_DEPTH] },
                              .normal = { .name = "normal", .image = view->layers[FRAME_NORMAL] },
                              .edges = { .name = "edges", .image = vct->pixels->edge_image },
                              .cone_normal = { .name = "cone_normal",
                                               .image = vct->pixels->cone_normal_image },
                              .across = gpu_groups(vct->pixels->width, VCT_LOCAL_2D),
                              .down = gpu_groups(vct->pixels->height, VCT_LOCAL_2D) };
    find_edges(vct, cmd, view, &p);
    trace_cones(vct, cmd, view, &p, result);
    const bool interleaved = params.interleave > 1;
    if (interleaved) gather_cones(vct, cmd, &p);
    if (params.step > 1)
        upsample(vct, cmd, view, &p, result);
    else if (interleaved)
        blur(vct, cmd, view, &p, result);
}
