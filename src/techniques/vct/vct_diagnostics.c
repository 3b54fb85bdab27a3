#include "techniques/vct/vct_diagnostics.h"

#include "techniques/vct/vct_frame.h"

#include <math.h>

// Doors, furniture and people are smaller than this, and so is the detail of their light.
static const float COARSE_M = 1.0f;

static const char *result_of(const struct vct_options *options)
{
    return options->occlusion ? "ambient occlusion" : "indirect light";
}

static void log_voxel_size(struct host *host, const char *technique,
                           const struct vct_options *options, const struct vct_grid *grid,
                           const char *scene)
{
    const int32_t *cells = grid->cells;
    const double side = (double)grid->cell_m;
    if (ldexpf(grid->cell_m, 1 - vct_clip_count(options)) <= COARSE_M)
        host_log(host, LOG_INFO, "gi %s: %s: %d x %d x %d voxels of %.3g m", technique, scene,
                 (int)cells[0], (int)cells[1], (int)cells[2], side);
    else
        host_log(host, LOG_WARNING,
                 "gi %s: %s is %.3g m long: with resolution=%d a voxel is %.3g m, and %s "
                 "has no finer detail",
                 technique, scene, side * (double)options->resolution, (int)options->resolution,
                 side, result_of(options));
}

void vct_log_diagnostics(struct host *host, const char *technique,
                         const struct vct_options *options, const struct scene_pose *pose)
{
    struct vct_grid grid;
    if (!vct_grid_fit(pose->bounds, options->resolution, &grid)) {
        host_log(host, LOG_WARNING, "gi %s: %s has no extent for a grid: there is no %s", technique,
                 pose->scene->name, result_of(options));
        return;
    }
    log_voxel_size(host, technique, options, &grid, pose->scene->name);
    for (int i = 1; i < vct_clip_count(options); i++)
        host_log(host, LOG_INFO, "gi %s: level %d has voxels of %.3g m", technique, i + 1,
                 ldexp((double)grid.cell_m, -i));
}

// ---- Overflow -----------------------------------------------------------------------------------

struct counters {
    uint32_t of[VCT_MAX_CLIPS][2]; // static and moving voxels of each level
};

static void copy_counters(struct vct_overflow *overflow, const struct vct_frame *frame)
{
    for (int i = 0; i < frame->clipmap->count; i++) {
        const struct vct_level_voxels *voxels = &frame->voxels->levels[i];
        const struct vct_voxel_set *sets[] = { &voxels->static_set, &voxels->dynamic_set };
        for (int k = 0; k < 2; k++)
            gpu_readback_copy(
                frame->cmd, &overflow->readback,
                offsetof(struct counters, of) + (size_t)(2 * i + k) * sizeof(uint32_t),
                sets[k]->arguments, offsetof(struct vct_voxel_counts, overflow), sizeof(uint32_t));
    }
}

void vct_watch_overflow(struct vct_overflow *overflow, const struct vct_frame *frame)
{
    vct_report_overflow(overflow, frame->options, frame->clipmap);
    if (frame->voxels->revoxelized) overflow->pending = true;
    if (!overflow->pending || overflow->readback.serial != 0) return;
    copy_counters(overflow, frame);
    overflow->pending = false;
}

void vct_report_overflow(struct vct_overflow *overflow, const struct vct_options *options,
                         const struct vct_clipmap *clipmap)
{
    struct counters counters;
    if (!gpu_readback_poll(overflow->gpu, &overflow->readback, &counters, sizeof counters)) return;
    for (int i = 0; i < clipmap->count; i++) {
        if (overflow->reported[i] || (counters.of[i][0] == 0 && counters.of[i][1] == 0)) continue;
        overflow->reported[i] = true;
        host_log(overflow->host, LOG_WARNING,
                 "gi %s: level %d, voxels of %.3g m: surfaces occupy more faces of voxels than the "
                 "capacity of %u; those beyond along z have no %s; use a lower resolution",
                 overflow->technique, i + 1, (double)clipmap->levels[i].grid.cell_m,
                 (unsigned)vct_capacity(options), result_of(options));
    }
}
