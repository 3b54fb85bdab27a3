// Log messages about scenes that do not suit the grid.
#pragma once

#include "core/host.h"
#include "gpu/gpu.h"
#include "scene/pose.h"
#include "techniques/vct/vct_options.h"
#include "techniques/vct/vct_shared.h"

struct vct_overflow { // of voxel sets, reported some frames later
    struct host *host;
    struct gpu *gpu;
    const char *technique;
    struct gpu_readback readback;
    bool reported[VCT_MAX_CLIPS];
    bool pending; // there are voxels whose counters have not been copied yet
};

struct vct_clipmap;
struct vct_frame;

// Size of the voxels, and scenes without extent. At creation.
void vct_log_diagnostics(struct host *host, const char *technique,
                         const struct vct_options *options, const struct scene_pose *pose);

// Reads the overflow counters of new voxels back without waiting. Once a frame, after voxelization.
// A level whose voxels exceed the capacity logs one warning, some frames later.
void vct_watch_overflow(struct vct_overflow *overflow, const struct vct_frame *frame);
// Logs counters that have been read back. Before destruction too: a short run ends before the next
// frame.
void vct_report_overflow(struct vct_overflow *overflow, const struct vct_options *options,
                         const struct vct_clipmap *clipmap);
