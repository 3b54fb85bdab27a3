#include "techniques/vct/vct_layout.h"

#include "techniques/vct/voxelize/voxelize_shared.h"

#include <stddef.h>

int vct_clip_count(const struct vct_options *options)
{
    if (options->levels > 0) return options->levels;
    return vct_pixels_have_rays(options) && options->fitted_levels > 0 ? options->fitted_levels : 1;
}

bool vct_has_svo(const struct vct_options *options)
{
    return options->storage == VCT_SVO;
}

static bool fits_rays(const struct vct_options *options)
{
    return !vct_has_svo(options) && options->anisotropic;
}

bool vct_pixels_have_rays(const struct vct_options *options)
{
    return options->trace == VCT_BY_RAYS && fits_rays(options);
}

bool vct_denoises(const struct vct_options *options)
{
    return options->temporal && vct_pixels_have_rays(options);
}

bool vct_has_rays(const struct vct_options *options)
{
    return options->occlusion ? vct_pixels_have_rays(options) : fits_rays(options);
}

uint32_t vct_step(const struct vct_options *options)
{
    return options->half_resolution ? 2 : 1;
}

uint32_t vct_block(const struct vct_options *options)
{
    return (uint32_t)options->interleave * vct_step(options);
}

// ---- Voxel sets ---------------------------------------------------------------------------------

static uint32_t voxel_count(const struct vct_options *options)
{
    const uint32_t dim = (uint32_t)options->resolution;
    return dim * dim * dim;
}

// The surfaces of a scene occupy a multiple of the voxels in a face of the grid: 6 for an empty
// room. A capacity of 32 also fits densely furnished scenes, with several faces in many voxels. At
// 256 voxels it is 26: the buffer of sums has at most the storage range that every device binds.
uint32_t vct_capacity(const struct vct_options *options)
{
    const uint32_t dim = (uint32_t)options->resolution, face = dim * dim;
    const uint32_t bound = (1u << 27) / (VCT_SUM_WORDS * (uint32_t)sizeof(uint32_t)) / face;
    const uint32_t most = (bound < 32 ? bound : 32) * face;
    return most < 6 * voxel_count(options) ? most : 6 * voxel_count(options);
}

uint32_t vct_level_faces(const struct vct_options *options)
{
    return gpu_groups(vct_capacity(options), VCT_VOXEL_ROW) * VCT_VOXEL_ROW;
}

size_t vct_mask_words(const struct vct_options *options)
{
    return voxel_count(options) / 4; // a byte for each voxel
}

size_t vct_block_count(const struct vct_options *options)
{
    return (vct_mask_words(options) + VCT_BLOCK_WORDS - 1) / VCT_BLOCK_WORDS;
}

// ---- The light volume ---------------------------------------------------------------------------

uint32_t vct_volume_dim(const struct vct_options *options)
{
    return (uint32_t)options->resolution / 2;
}

// Down to a few texels along each side, as long as sides are even.
uint32_t vct_volume_mips(const struct vct_options *options)
{
    uint32_t mips = 1;
    for (uint32_t dim = vct_volume_dim(options); dim % 2 == 0 && dim > 2; dim /= 2) mips++;
    return mips;
}

uint32_t vct_direction_count(const struct vct_options *options)
{
    return options->anisotropic ? 6 : 1;
}

struct gpu_image_desc vct_light_desc(const struct vct_options *options)
{
    if (vct_has_svo(options)) return vct_svo_pool(options);
    const uint32_t dim = vct_volume_dim(options);
    return (struct gpu_image_desc){ .name = "light",
                                    .dimension = GPU_3D,
                                    .format = options->occlusion ? GPU_R16F : GPU_RGBA16F,
                                    .width = vct_direction_count(options) * dim,
                                    .height = dim,
                                    .depth = (uint32_t)vct_clip_count(options) * dim,
                                    .mips = vct_volume_mips(options),
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

struct gpu_image_desc vct_blocks_desc(const struct vct_options *options, enum gpu_format format)
{
    const bool used = vct_has_rays(options);
    const uint32_t dim = used ? vct_volume_dim(options) : 1;
    return (struct gpu_image_desc){ .name = "blocks",
                                    .dimension = GPU_3D,
                                    .format = format,
                                    .width = dim,
                                    .height = dim,
                                    .depth = used ? (uint32_t)vct_clip_count(options) * dim : 1,
                                    .mips = 1,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// ---- Lists of occupied texels -------------------------------------------------------------------

static size_t level_texels(const struct vct_options *options, uint32_t level)
{
    const size_t dim = vct_volume_dim(options) >> level;
    return dim * dim * dim;
}

struct vct_texels_push vct_texels_push(const struct vct_options *options, uint32_t levels)
{
    struct vct_texels_push push = { .levels = levels,
                                    .directions = vct_direction_count(options),
                                    .block_level = vct_block_level(options) };
    size_t first = 0;
    for (uint32_t level = 0; level < push.levels && level < VCT_MAX_LEVELS; level++) {
        push.first[level] = (uint32_t)first;
        first += level_texels(options, level);
        // A bit for each texel beyond mip 0, in the order of the lists.
        push.mask_first[level] = push.first[level] - (level > 0 ? push.first[1] : 0);
    }
    return push;
}

// Blocks have 8 voxels along a side where voxels are no larger than with the default resolution,
// otherwise 4.
uint32_t vct_block_level(const struct vct_options *options)
{
    return options->resolution >= 128 ? 2 : 1;
}

size_t vct_texel_words(const struct vct_options *options)
{
    size_t words = 0;
    for (uint32_t level = 0; level < vct_volume_mips(options); level++)
        words += level_texels(options, level);
    return words;
}

size_t vct_texel_mask_words(const struct vct_options *options)
{
    return (vct_texel_words(options) - level_texels(options, 0) + 31) / 32 + 1;
}

size_t vct_level_groups(uint32_t level)
{
    return offsetof(struct vct_texel_levels, groups) + 3 * sizeof(uint32_t) * level;
}

// ---- The octree ---------------------------------------------------------------------------------

// Leaves along a side: four voxels each, and a power of two of them.
static uint32_t leaf_dim(const struct vct_options *options)
{
    uint32_t dim = 1;
    while (4 * dim < (uint32_t)options->resolution) dim *= 2;
    return dim;
}

// Bricks for 14 times the leaves in a face of the grid, all levels together, or for all nodes.
// Rooms and courtyards of 64 to 256 voxels need 4 to 9 times.
struct vct_svo_params vct_svo_params(const struct vct_options *options)
{
    const uint32_t dim = leaf_dim(options), inner = (dim * dim * dim - 1) / 7;
    const uint32_t all = inner + dim * dim * dim, most = 14 * dim * dim;
    struct vct_svo_params params = { .bricks = most < all ? most : all, .row = 1 };
    params.tiles = inner < params.bricks ? inner : params.bricks;
    for (uint32_t d = dim; d > 0; d /= 2) params.depths++;
    while ((uint32_t)(params.row * params.row * params.row) < params.bricks) params.row *= 2;
    return params;
}

// The root's tile, of which only the root is used, and the tiles of children.
size_t vct_svo_nodes(const struct vct_options *options)
{
    return 8 * ((size_t)vct_svo_params(options).tiles + 1);
}

struct gpu_image_desc vct_svo_pool(const struct vct_options *options)
{
    const struct vct_svo_params params = vct_svo_params(options);
    const uint32_t row = (uint32_t)params.row;
    return (struct gpu_image_desc){ .name = "bricks",
                                    .dimension = GPU_3D,
                                    .format = GPU_RGBA16F,
                                    .width = 3 * vct_direction_count(options) * row,
                                    .height = 3 * row,
                                    .depth = 3 * gpu_groups(params.bricks, row * row),
                                    .mips = 1,
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}
