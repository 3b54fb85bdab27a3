// Sizes of all buffers and images, from the options alone.
#pragma once

#include "gpu/gpu.h"
#include "techniques/vct/octree/octree_shared.h"
#include "techniques/vct/vct_options.h"
#include "techniques/vct/volume/volume_shared.h"

int vct_clip_count(const struct vct_options *options);
// Rays need anisotropic voxels in grids. Voxels use them where they can, pixels by option.
bool vct_pixels_have_rays(const struct vct_options *options);
// Whether accumulated irradiance is filtered over pixels.
bool vct_denoises(const struct vct_options *options);
bool vct_has_rays(const struct vct_options *options);
bool vct_has_svo(const struct vct_options *options);
// Pixels of the frame per pixel that traces cones, in x and y.
uint32_t vct_step(const struct vct_options *options);
// Pixels of the frame along a side of a block that shares one set of cones.
uint32_t vct_block(const struct vct_options *options);

// Voxel sets.
uint32_t vct_capacity(const struct vct_options *options); // occupied faces of voxels
// The capacity in whole rows of an image.
uint32_t vct_level_faces(const struct vct_options *options);
size_t vct_mask_words(const struct vct_options *options);
size_t vct_block_count(const struct vct_options *options);

// The light volume.
uint32_t vct_volume_dim(const struct vct_options *options);
uint32_t vct_volume_mips(const struct vct_options *options);
uint32_t vct_direction_count(const struct vct_options *options); // volumes side by side: 6 or 1
// Without rays a single texel: images of a shader are always bound.
struct gpu_image_desc vct_blocks_desc(const struct vct_options *options, enum gpu_format format);
struct gpu_image_desc vct_light_desc(const struct vct_options *options); // mips or brick pool

// Lists of occupied texels, one for each mip.
struct vct_texels_push vct_texels_push(const struct vct_options *options, uint32_t levels);
// The mip whose texels are the blocks of lighting/bounce.comp.
uint32_t vct_block_level(const struct vct_options *options);
size_t vct_texel_words(const struct vct_options *options);
size_t vct_texel_mask_words(const struct vct_options *options);
size_t vct_level_groups(uint32_t level); // offset of a mip's dispatch in vct_texel_levels

// The octree.
struct vct_svo_params vct_svo_params(const struct vct_options *options);
size_t vct_svo_nodes(const struct vct_options *options);
struct gpu_image_desc vct_svo_pool(const struct vct_options *options);
