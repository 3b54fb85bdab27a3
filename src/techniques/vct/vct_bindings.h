// Bindings that shaders of several folders share.
#pragma once

#include "frame/frame.h"

struct vct_frame;

// Uniform block "vct_grid": the frame's parameters with the grid of a level of the clip map.
struct gpu_binding vct_grid_binding(const struct vct_frame *frame, int level);
// Uniform block "vct_clipmap": the grids as pixels sample them, around the camera.
struct gpu_binding vct_clipmap_binding(const struct vct_frame *frame);
// The grids as voxels sample them: whole, with the placement of the filled light volume.
struct gpu_binding vct_lit_clipmap_binding(const struct vct_frame *frame);
// Uniform block "vct_svo". Shaders without an octree ignore it.
struct gpu_binding vct_svo_binding(const struct vct_frame *frame);
// Storage block "vct_small_emitters".
struct gpu_binding vct_small_emitters_binding(const struct vct_frame *frame);
// The layer that the cones fill: irradiance or visibility.
gpu_image vct_result(const struct vct_frame *frame);

// Bindings that pixels and voxels trace through: the light and all that rays and cones meet.
#define VCT_TRACE_BINDINGS(frame)                                                                  \
    { .name = "light", .image = (frame)->volume->light, .sampler = (frame)->volume->linear },      \
        VCT_RAY_BINDINGS(frame), vct_svo_binding(frame),                                           \
    {                                                                                              \
        .name = "vct_svo_nodes", .buffer = (frame)->svo->nodes                                     \
    }

// Bindings that rays read (rays/ray.glsl), of the grid of the whole scene.
#define VCT_RAY_BINDINGS(frame)                                                                    \
    { .name = "vct_blocks", .image = (frame)->rays->block_image },                                 \
        { .name = "static_first_slots", .image = (frame)->rays->first_slots[0] },                  \
        { .name = "dynamic_first_slots", .image = (frame)->rays->first_slots[1] },                 \
        { .name = "static_planes", .image = (frame)->voxels->levels[0].static_set.planes },        \
        { .name = "dynamic_planes", .image = (frame)->voxels->levels[0].dynamic_set.planes },      \
        VCT_BOTH_SETS(&(frame)->voxels->levels[0])

// Bindings of the voxels of both sets of a level, as volume/prefilter.glsl reads them.
#define VCT_BOTH_SETS(level)                                                                       \
    { .name = "static_mask", .buffer = (level)->static_set.mask },                                 \
        { .name = "static_word_offsets", .buffer = (level)->static_set.word_offsets },             \
        { .name = "static_lit_voxels", .image = (level)->static_set.lit_voxels },                  \
        { .name = "dynamic_mask", .buffer = (level)->dynamic_set.mask },                           \
        { .name = "dynamic_word_offsets", .buffer = (level)->dynamic_set.word_offsets },           \
    {                                                                                              \
        .name = "dynamic_lit_voxels", .image = (level)->dynamic_set.lit_voxels                     \
    }
