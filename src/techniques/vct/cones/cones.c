#include "techniques/vct/cones/cones.h"

#include "techniques/vct/cones/temporal.h"
#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

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

static struct vct_cone_params params_of(const struct vct_frame *frame, int choice, uint32_t side)
{
    const struct vct_options *options = frame->options;
    return (struct vct_cone_params){
        .cone_count = (uint32_t)vct_cone_count(choice),
        .interleave = side,
        .step = 1,
        .width = frame->view->width,
        .height = frame->view->height,
        .width_per_m = options->step_size * vct_cone_width(choice),
        .offset = options->offset,
        .gain = options->gain,
        .columns = columns_of((uint32_t)vct_cone_count(choice)),
        .texel_m = vct_clipmap_texel_m(frame->clipmap),
        .last_mip = vct_volume_mips(options) - 1,
        .environment_sigma = 0.5f * atanf(0.5f * vct_cone_width(choice)),
    };
}

struct vct_cone_params vct_voxel_cones(const struct vct_frame *frame)
{
    const int choice = vct_has_rays(frame->options) ? VCT_CONES_9 : VCT_CONES_6;
    struct vct_cone_params params = params_of(frame, choice, 1);
    // Wide samples mix both sides of a wall, and each bounce adds to the leak.
    params.width_per_m = frame->options->step_size * vct_cone_width(VCT_CONES_25);
    struct vct_cone cones[VCT_MAX_CONES];
    vct_cone_set(choice, cones);
    for (uint32_t i = 0; i < params.cone_count; i++)
        params.cones[i] = vec4_of(cones[i].direction, cones[i].weight);
    return params;
}

// Low discrepancy over frames: multiples of the golden ratio.
static float chance_of(uint32_t frame)
{
    const double turns = 0.6180339887498949 * (double)frame;
    return (float)(turns - floor(turns));
}

// World-space axes. Each cone's weight, 1/count, is divided among the pixels of a block that trace
// it.
static struct vct_cone_params pixel_cones(const struct vct_cones *cones,
                                          const struct vct_pixels *pixels,
                                          const struct vct_temporal *temporal,
                                          const struct vct_frame *frame)
{
    const uint32_t side = (uint32_t)frame->options->interleave;
    struct vct_cone_params params = params_of(frame, frame->options->cones, side);
    const uint32_t count = params.cone_count;
    params.step = vct_step(frame->options);
    params.width = pixels->width;
    params.height = pixels->height;
    for (uint32_t i = 0; i < count; i++)
        params.cones[i] =
            vec4_of(cones->axes[i],
                    1.0f / (float)(count * (uint32_t)pixels_tracing(i, side * side, count)));
    vct_stratum_axes(temporal ? temporal->number : 0, params.set_axes);
    params.level_chance = temporal ? chance_of(temporal->number) : 0.0f;
    if (temporal) vct_temporal_rotate_cones(temporal, &params);
    return params;
}

// Arguments that the per-pixel passes share.
struct passes {
    const struct vct_cones *cones;
    const struct vct_pixels *pixels;
    const struct vct_frame *frame;
    gpu_image result;
    struct gpu_binding clipmap, set, depth, normal, edges, cone_normal;
    uint32_t across, down; // workgroups, one invocation per traced pixel
};

static void trace_cones(const struct passes *p)
{
    const struct vct_frame *frame = p->frame;
    const struct frame_view *view = frame->view;
    const uint32_t side = (uint32_t)frame->options->interleave; // of a block
    gpu_scope_begin(frame->cmd, "cones");
    gpu_dispatch(frame->cmd, p->cones->trace[vct_light_variant(frame)],
                 GPU_BIND(vct_grid_binding(frame, 0), p->clipmap, view->constants_binding,
                          view->environment_binding, p->set, p->depth, p->normal, p->cone_normal,
                          { .name = "red", .image = p->pixels->traced[0] },
                          { .name = "green", .image = p->pixels->traced[1] },
                          { .name = "blue", .image = p->pixels->traced[2] },
                          { .name = "irradiance", .image = p->result }, VCT_TRACE_BINDINGS(frame),
                          vct_small_emitters_binding(frame)),
                 NULL, 0,
                 side * side * gpu_groups(gpu_groups(p->pixels->width, side), VCT_LOCAL_2D),
                 gpu_groups(gpu_groups(p->pixels->height, side), VCT_LOCAL_2D), 1);
    gpu_scope_end(frame->cmd);
}

static void gather(const struct passes *p, gpu_pipeline pipeline, const gpu_image from[3],
                   const gpu_image to[3], uint32_t across, uint32_t down)
{
    gpu_dispatch(
        p->frame->cmd, pipeline,
        GPU_BIND(p->set, p->normal, p->edges, { .name = "red", .image = from[0] },
                 { .name = "green", .image = from[1] }, { .name = "blue", .image = from[2] },
                 { .name = "red_sum", .image = to[0] }, { .name = "green_sum", .image = to[1] },
                 { .name = "blue_sum", .image = to[2] },
                 { .name = "irradiance", .image = p->pixels->gathered_irradiance }),
        NULL, 0, across, down, 1);
}

static void find_edges(const struct passes *p)
{
    struct gpu_cmd *cmd = p->frame->cmd;
    gpu_scope_begin(cmd, "edges");
    gpu_dispatch(cmd, p->cones->edges,
                 GPU_BIND(p->frame->view->constants_binding, p->clipmap, p->set, p->depth,
                          p->normal, p->edges, p->cone_normal),
                 NULL, 0, p->across, p->down, 1);
    gpu_scope_end(cmd);
}

static void gather_cones(const struct passes *p)
{
    const struct vct_pixels *pixels = p->pixels;
    const int largest = p->frame->options->interleave == VCT_MAX_INTERLEAVE;
    gpu_scope_begin(p->frame->cmd, "gather");
    gather(p, p->cones->gather_rows[largest], pixels->traced, pixels->gathered,
           gpu_groups(pixels->width, VCT_LOCAL_2D * VCT_GATHER_ROW), p->down);
    gather(p, p->cones->gather_columns[largest], pixels->gathered, pixels->traced, p->across,
           gpu_groups(pixels->height, VCT_LOCAL_2D * VCT_GATHER_ROW));
    gpu_scope_end(p->frame->cmd);
}

// For pixels that gathered only a small fraction of the cone set.
static void blur(const struct passes *p)
{
    struct gpu_cmd *cmd = p->frame->cmd;
    gpu_scope_begin(cmd, "blur");
    gpu_dispatch(
        cmd, p->cones->blur,
        GPU_BIND(p->frame->view->constants_binding, p->clipmap, p->set, p->depth, p->normal,
                 { .name = "gathered", .image = p->pixels->gathered_irradiance },
                 { .name = "irradiance", .image = p->result }),
        NULL, 0, gpu_groups(p->across, VCT_BLUR_TILE), gpu_groups(p->down, VCT_BLUR_TILE), 1);
    gpu_scope_end(cmd);
}

// From half resolution to full resolution.
static void upsample(const struct passes *p)
{
    struct gpu_cmd *cmd = p->frame->cmd;
    gpu_scope_begin(cmd, "upsample");
    gpu_dispatch(cmd, p->cones->upsample,
                 GPU_BIND(p->frame->view->constants_binding, p->clipmap, p->set, p->depth,
                          p->normal, p->cone_normal,
                          { .name = "red", .image = p->pixels->traced[0] },
                          { .name = "green", .image = p->pixels->traced[1] },
                          { .name = "blue", .image = p->pixels->traced[2] },
                          { .name = "irradiance", .image = p->result }),
                 NULL, 0, p->across, p->down, 1);
    gpu_scope_end(cmd);
}

void vct_record_cones(const struct vct_cones *cones, const struct vct_pixels *pixels,
                      const struct vct_temporal *temporal, const struct vct_frame *frame)
{
    const struct frame_view *view = frame->view;
    const struct vct_cone_params params = pixel_cones(cones, pixels, temporal, frame);
    const struct passes p = {
        .cones = cones,
        .pixels = pixels,
        .frame = frame,
        .result = temporal ? vct_temporal_now(temporal) : vct_result(frame),
        .clipmap = vct_clipmap_binding(frame),
        .set = gpu_transient(frame->cmd, "vct_cones", &params, sizeof params),
        .depth = { .name = "depth", .image = view->layers[FRAME_DEPTH] },
        .normal = { .name = "normal", .image = view->layers[FRAME_NORMAL] },
        .edges = { .name = "edges", .image = pixels->edge_image },
        .cone_normal = { .name = "cone_normal", .image = pixels->cone_normal_image },
        .across = gpu_groups(pixels->width, VCT_LOCAL_2D),
        .down = gpu_groups(pixels->height, VCT_LOCAL_2D),
    };
    find_edges(&p);
    trace_cones(&p);
    const bool interleaved = params.interleave > 1;
    if (interleaved) gather_cones(&p);
    if (params.step > 1)
        upsample(&p);
    else if (interleaved)
        blur(&p);
}
