// The state of voxel cone tracing, shared by its folders.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/vct/clipmap/clipmap.h"
#include "techniques/vct/cones/cones.h"
#include "techniques/vct/cones/temporal.h"
#include "techniques/vct/lighting/lighting.h"
#include "techniques/vct/octree/octree.h"
#include "techniques/vct/rays/rays.h"
#include "techniques/vct/vct_layout.h"
#include "techniques/vct/vct_options.h"
#include "techniques/vct/vct_shared.h"
#include "techniques/vct/vct_small_emitters.h"
#include "techniques/vct/volume/volume.h"
#include "techniques/vct/voxelize/voxelize.h"

// A level of the clip map: a grid and its voxels. The first one covers the whole scene.
struct vct_clip {
    struct vct_grid grid;                         // of this frame
    struct vct_grid lit_grid;                     // when the light volume was filled
    struct box3 cone_box;                         // see vct_grid_cone_box
    struct vct_voxel_set static_set, dynamic_set; // of draws that have never moved; of the others
    gpu_buffer texels, texel_mask, texel_counts;  // occupied texels of the light volume
    bool static_valid;                            // static_set is that of the scene
    bool revoxelized;                             // in this frame
    bool new_statics;                             // static_set is another one in this frame
};

struct vct_overflow { // of voxel sets, reported some frames later
    struct gpu_readback readback;
    bool reported[VCT_MAX_CLIPS];
    bool pending; // there are voxels whose counters have not been copied yet
};

// Images of traced pixels, of one view at a time.
struct vct_pixels {
    uint32_t width, height;
    gpu_image edge_image;             // R8: discontinuities
    gpu_image cone_normal_image;      // RG16F: octahedral, axis of each pixel's cone set
    gpu_image traced[3], gathered[3]; // RGBA16F: cone sums of each colour
    gpu_image gathered_irradiance;    // RGBA16F: irradiance, fraction of the cone set
    // RGBA16F, full size: radiance in the specular lobe, and its mean over pixels and frames with
    // its weight in frames, of this frame and of the previous one.
    gpu_image arriving, averaged[2];
};

struct vct_view {
    struct vct_pixels pixels;     // empty if there is no such view
    struct vct_temporal temporal; // with temporal
};

struct vct {
    struct vct_options options;
    const char *name; // of the technique, for messages
    struct host *host;
    struct gpu *gpu;

    // Pipelines.
    struct vct_voxelize_pipelines mark, outermost[2]; // opaque, masked
    struct vct_voxelize_pipelines add[VCT_DRAW_KINDS];
    gpu_pipeline count, scan, list, zero, surfaces;
    gpu_pipeline texel_lists, planes, blocks, parts, mip;
    gpu_pipeline fill[2];                          // without and with moving voxels
    gpu_pipeline inject[2];                        // without and with lights
    gpu_pipeline cones[4], bounce[4], specular[4]; // by vct_light_variant
    gpu_pipeline lobe_average, reflect;
    gpu_pipeline gather_rows[2], gather_columns[2]; // of any interleave, of the largest
    gpu_pipeline edges, blur, upsample, debug;
    struct vct_temporal_pipelines history;

    // Voxels and the light volume.
    struct vct_small_emitters small_emitters;
    struct vct_clip clips[VCT_MAX_CLIPS];
    int clip_count;
    gpu_buffer queue, queue_state; // tiles of large triangles
    gpu_buffer sums;               // over the triangles of the faces of a set
    gpu_sampler linear;
    struct vct_svo svo;       // with storage=svo
    gpu_image light;          // RGBA16F: six volumes side by side with mips, or the pool of bricks.
                              // vctao, mips: R16F
    gpu_image block_image;    // RGBA32U, of the first grid: see rays/rays_shared.h
    gpu_image first_slots[2]; // R32U, of each block and set

    struct vct_view views[FRAME_MAX_VIEWS];
    struct vct_pixels *pixels;     // of the view being recorded
    struct vct_temporal *temporal; // likewise
    int begun;                     // view whose history and points are those of the frame

    vec3s cone_axes[VCT_MAX_CONES];

    // Kept between frames.
    struct kept kept;
    struct vct_params params; // of the frame being recorded, but for the placement of a grid
    bool ready;               // the grids are placed
    bool revoxelized;         // some voxels of this frame are new
    bool light_valid;         // the light volume is that of the previous frame, of this grid
    bool light_outdated;      // it has texels whose voxels are gone
    bool bounced_valid;       // bounced irradiance is that of `bounce_inputs`
    struct vct_bounce_inputs bounce_inputs;
    int bounces_left;          // that still propagate a change of light
    bool settles;              // there were some when the frame began
    const struct scene *scene; // of the voxels
    uint64_t draw_list;        // of scene_gpu, as is static_set
    uint64_t static_set;       // of the static voxels
    int moving_draws;          // in the previous frame
    struct vct_overflow overflow;
};

// Number of the variant of a pass that traces: + 1 if there are moving voxels, + 2 if the frame has
// small emitters or a map of the environment.
static inline int vct_light_variant(const struct vct *vct, const struct frame_view *view)
{
    const bool more = !vct->options.occlusion &&
                      (vct->small_emitters.count > 0 || view->constants->environment_scale > 0.0f);
    return (vct->moving_draws > 0) + 2 * more;
}
