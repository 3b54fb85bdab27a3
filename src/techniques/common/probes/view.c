// Host code of the debug view of probes.
#include "techniques/common/probes/view.h"

#include "techniques/common/probes/view_shared.h"

#include "technique_shaders.h"

enum { LOCAL = 8, MAX_SPHERES = 16 };

bool probe_view_create(struct probe_view *view, struct gpu *gpu)
{
    const struct gpu_sampler_desc linear = { .name = "probe_view.linear",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return gpu_sampler_get(gpu, &linear, &view->linear) &&
           gpu_compute_pipeline_create(gpu, "probe_view", &shader_common_probes_view_comp, NULL, 0,
                                       &view->pipeline);
}

void probe_view_destroy(struct probe_view *view, struct gpu *gpu)
{
    gpu_pipeline_destroy(gpu, &view->pipeline);
}

// Probes from one sphere to the next, so that a side has at most MAX_SPHERES.
static int32_t sphere_spacing(struct frame_probes grid)
{
    int32_t most = grid.count_x > grid.count_y ? grid.count_x : grid.count_y;
    if (grid.count_z > most) most = grid.count_z;
    return (most + MAX_SPHERES - 1) / MAX_SPHERES;
}

void probe_view_record(const struct probe_view *view, struct gpu_cmd *cmd,
                       const struct frame_view *frame, const struct probe_volume *volume,
                       gpu_image out)
{
    const struct probe_view_push push = { volume->grid, sphere_spacing(volume->grid),
                                          probe_volume_visibility(volume) };
    const gpu_image depths = volume->depth.id ? volume->depth : frame->layers[FRAME_NORMAL];
    gpu_scope_begin(cmd, "probe_view");
    gpu_dispatch(
        cmd, view->pipeline,
        GPU_BIND(frame->constants_binding, { .name = "depth", .image = frame->layers[FRAME_DEPTH] },
                 { .name = "normal", .image = frame->layers[FRAME_NORMAL] },
                 { .name = "albedo", .image = frame->layers[FRAME_ALBEDO] },
                 { .name = "probes", .image = volume->image, .sampler = view->linear },
                 { .name = "probe_depths", .image = depths, .sampler = view->linear },
                 { .name = "target", .image = out }),
        &push, sizeof push, gpu_groups(frame->width, LOCAL), gpu_groups(frame->height, LOCAL), 1);
    gpu_scope_end(cmd);
}
