// Which texels of the light volume hold something, level by level: light is filled in and filtered
// there alone.
#include "techniques/vct/vct_state.h"

static size_t level_texels(const struct vct_options *options, uint32_t level)
{
    const size_t dim = vct_volume_dim(options) >> level;
    return dim * dim * dim;
}

struct vct_texels_push vct_texels_push(const struct vct_options *options, uint32_t levels)
{
    struct vct_texels_push push = { .levels = levels,
                                    .ways = vct_ways(options),
                                    .block_level = vct_block_level(options) };
    size_t first = 0;
    for (uint32_t level = 0; level < push.levels; level++) {
        push.first[level] = (uint32_t)first;
        first += level_texels(options, level);
        // A bit for each texel that comes after those of the finest level, in the same order.
        push.mask_first[level] = push.first[level] - (level > 0 ? push.first[1] : 0);
    }
    return push;
}

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

void vct_record_texels(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    // Grids but the first have no mips, but blocks that light is brought to.
    const uint32_t levels = clip == &vct->clips[0] ? vct_volume_mips(&vct->options)
                                                   : vct_block_level(&vct->options) + 1;
    const struct vct_texels_push push = vct_texels_push(&vct->options, levels);
    const size_t counts = offsetof(struct vct_texel_levels, count);
    const size_t words = gpu_buffer_bytes(vct->gpu, clip->rest.mask) / sizeof(uint32_t);
    vct_pass_begin(vct->name, cmd, "texels");
    // At least one group each: a dispatch is never empty.
    gpu_fill_buffer(cmd, clip->texel_state, 0, counts, 1);
    gpu_fill_buffer(cmd, clip->texel_state, counts, sizeof(struct vct_texel_levels) - counts, 0);
    gpu_fill_buffer(cmd, clip->texel_mask, 0, gpu_buffer_bytes(vct->gpu, clip->texel_mask), 0);
    gpu_dispatch(cmd, vct->texel_lists,
                 GPU_BIND(vct_grid_binding(vct, clip, cmd),
                          { .name = "static_mask", .buffer = clip->rest.mask },
                          { .name = "dynamic_mask", .buffer = clip->moving.mask },
                          { .name = "vct_texel_mask", .buffer = clip->texel_mask },
                          { .name = "vct_texels", .buffer = clip->texels },
                          { .name = "vct_texel_state", .buffer = clip->texel_state }),
                 &push, sizeof push, gpu_groups((uint32_t)words, VCT_LOCAL), 1, 1);
    vct->light_outdated = true;
    gpu_scope_end(cmd);
}
