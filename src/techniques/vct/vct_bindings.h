// Bindings that shaders of several folders share.
#pragma once

#include "frame/frame.h"

struct vct;
struct vct_clip;

// Uniform block "vct_grid": vct->params with the grid of a level.
struct gpu_binding vct_grid_binding(const struct vct *vct, const struct vct_clip *clip,
                                    struct gpu_cmd *cmd);
// Uniform block "vct_svo". Shaders without an octree ignore it.
struct gpu_binding vct_svo_binding(const struct vct *vct, struct gpu_cmd *cmd);
// Storage block "vct_small_emitters".
struct gpu_binding vct_small_emitters_binding(const struct vct *vct, struct gpu_cmd *cmd);
// The layer that the cones fill: irradiance or visibility.
gpu_image vct_result(const struct vct *vct, const struct frame_view *view);

// Bindings of a level that rays read (rays/ray.glsl).
#define VCT_RAY_BINDINGS(vct, clip)                                                                \
    { .name = "vct_blocks", .image = (vct)->block_image },                                         \
        { .name = "static_first_slots", .image = (vct)->first_slots[0] },                          \
        { .name = "dynamic_first_slots", .image = (vct)->first_slots[1] },                         \
        { .name = "static_planes", .image = (clip)->static_set.planes },                           \
        { .name = "dynamic_planes", .image = (clip)->dynamic_set.planes }, VCT_BOTH_SETS(clip)

// Bindings of the voxels of both sets of a level, as volume/prefilter.glsl reads them.
#define VCT_BOTH_SETS(clip)                                                                        \
    { .name = "static_mask", .buffer = (clip)->static_set.mask },                                  \
        { .name = "static_word_offsets", .buffer = (clip)->static_set.word_offsets },              \
        { .name = "static_lit_voxels", .image = (clip)->static_set.lit_voxels },                   \
        { .name = "dynamic_mask", .buffer = (clip)->dynamic_set.mask },                            \
        { .name = "dynamic_word_offsets", .buffer = (clip)->dynamic_set.word_offsets },            \
    {                                                                                              \
        .name = "dynamic_lit_voxels", .image = (clip)->dynamic_set.lit_voxels                      \
    }
