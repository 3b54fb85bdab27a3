// Bindings that shaders of several folders share.
#pragma once

#include "frame/frame.h"

struct vct_frame;

// Uniform block "vct_grid": the frame's parameters with the grid of a level of the clip map.
struct gpu_binding vct_grid_binding(const struct vct_frame *frame, int level);
// Uniform block "vct_clipmap": the grids as pixels sample them, around the camera.
struct gpu_binding vct_clipmap_binding(const struct vct_frame *frame);
// The grids as voxels sample them.
struct gpu_binding vct_voxel_clipmap_binding(const struct vct_frame *frame);
// Uniform block "vct_svo". Shaders without an octree ignore it.
struct gpu_binding vct_svo_binding(const struct vct_frame *frame);
// Storage block "vct_small_emitters".
struct gpu_binding vct_small_emitters_binding(const struct vct_frame *frame);
// The layer that the cones fill: irradiance or visibility.
gpu_image vct_result(const struct vct_frame *frame);

// Bindings that pixels and voxels trace through: the light and all that rays and cones meet.
#define VCT_TRACE_BINDINGS(frame)                                                                  \
    { .name = "light", .image = (frame)->volume->light, .sampler = (frame)->volume->linear },      \
        VCT_RAY_BINDINGS(frame), VCT_LIT_BINDINGS(frame), vct_svo_binding(frame),                  \
    {                                                                                              \
        .name = "vct_svo_nodes", .buffer = (frame)->svo->nodes                                     \
    }

// Bindings that rays read (rays/ray.glsl), of all levels.
#define VCT_RAY_BINDINGS(frame)                                                                    \
    { .name = "vct_blocks", .image = (frame)->rays->block_image },                                 \
        { .name = "static_first_slots", .image = (frame)->rays->first_slots[0] },                  \
        { .name = "dynamic_first_slots", .image = (frame)->rays->first_slots[1] },                 \
        { .name = "static_planes", .image = (frame)->voxels->planes[0] },                          \
    {                                                                                              \
        .name = "dynamic_planes", .image = (frame)->voxels->planes[1]                              \
    }

// The light of the faces of both sets, of all levels.
#define VCT_LIT_BINDINGS(frame)                                                                    \
    { .name = "static_lit_voxels", .image = (frame)->voxels->lit_voxels[0] },                      \
    {                                                                                              \
        .name = "dynamic_lit_voxels", .image = (frame)->voxels->lit_voxels[1]                      \
    }

// Bindings of the voxels of both sets of a level: their slots.
#define VCT_BOTH_SETS(level)                                                                       \
    { .name = "static_mask", .buffer = (level)->static_set.mask },                                 \
        { .name = "static_word_offsets", .buffer = (level)->static_set.word_offsets },             \
        { .name = "dynamic_mask", .buffer = (level)->dynamic_set.mask },                           \
    {                                                                                              \
        .name = "dynamic_word_offsets", .buffer = (level)->dynamic_set.word_offsets                \
    }
