#include "techniques/vct/volume/volume.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

void vct_volume_list_texels(struct vct_volume *volume, const struct vct_frame *frame, int level)
{
    const struct vct_options *options = frame->options;
    const struct vct_level_voxels *voxels = &frame->voxels->levels[level];
    const struct vct_level_texels *texels = &volume->levels[level];
    // Light has mips in the first level alone. The blocks of lighting/bounce.comp are texels of
    // one, and rays skip empty texels of all.
    const bool all = level == 0 || vct_has_rays(options);
    const uint32_t mips = all ? vct_volume_mips(options) : vct_block_level(options) + 1;
    const struct vct_texels_push push = vct_texels_push(options, mips);
    const size_t counts = offsetof(struct vct_texel_levels, count);
    struct gpu_cmd *cmd = frame->cmd;
    gpu_scope_begin(cmd, "texels");
    // At least one group each: a dispatch is never empty.
    gpu_fill_buffer(cmd, texels->counts, 0, counts, 1);
    gpu_fill_buffer(cmd, texels->counts, counts, sizeof(struct vct_texel_levels) - counts, 0);
    gpu_fill_buffer(cmd, texels->mask, 0, sizeof(uint32_t) * vct_texel_mask_words(options), 0);
    gpu_dispatch(cmd, volume->texels,
                 GPU_BIND(vct_grid_binding(frame, level),
                          { .name = "static_mask", .buffer = voxels->static_set.mask },
                          { .name = "dynamic_mask", .buffer = voxels->dynamic_set.mask },
                          { .name = "vct_texel_mask", .buffer = texels->mask },
                          { .name = "vct_texels", .buffer = texels->list },
                          { .name = "vct_texel_counts", .buffer = texels->counts }),
                 &push, sizeof push,
                 gpu_groups((uint32_t)vct_mask_words(options), 2 * VCT_TEXELS_EACH * VCT_LOCAL), 1,
                 1);
    volume->outdated = true;
    gpu_scope_end(cmd);
}

static void fill(const struct vct_volume *volume, const struct vct_frame *frame, int level)
{
    const struct vct_level_texels *texels = &volume->levels[level];
    gpu_dispatch_indirect(
        frame->cmd, volume->fill[vct_frame_moves(frame)],
        GPU_BIND(vct_grid_binding(frame, level), VCT_BOTH_SETS(&frame->voxels->levels[level]),
                 VCT_LIT_BINDINGS(frame), { .name = "light", .image = volume->light },
                 { .name = "vct_texels", .buffer = texels->list },
                 { .name = "vct_texel_counts", .buffer = texels->counts }),
        NULL, 0, texels->counts, vct_level_groups(0));
}

// Texels of a mip that are in use, rounded up.
static int32_t mip_size(int32_t cells, uint32_t level)
{
    const int32_t size = (cells / 2 + (1 << level) - 1) >> level;
    return size > 1 ? size : 1;
}

// Mips of the grid of the whole scene.
static void filter(const struct vct_volume *volume, const struct vct_frame *frame)
{
    const struct vct_options *options = frame->options;
    const struct vct_level_texels *texels = &volume->levels[0];
    const struct vct_texels_push lists = vct_texels_push(options, vct_volume_mips(options));
    const int32_t dim = (int32_t)vct_volume_dim(options),
                  *cells = frame->clipmap->levels[0].grid.cells;
    for (uint32_t level = 1; level < lists.levels; level++) {
        const struct vct_mip_push push = {
            .source_x = mip_size(cells[0], level - 1),
            .source_y = mip_size(cells[1], level - 1),
            .source_z = mip_size(cells[2], level - 1),
            .source_tile = dim >> (level - 1),
            .target_tile = dim >> level,
            .level = level,
            .first = lists.first[level],
        };
        gpu_dispatch_indirect(
            frame->cmd, volume->mip,
            GPU_BIND(
                { .name = "source", .image = volume->light, .mip = level - 1, .one_mip = true },
                { .name = "target", .image = volume->light, .mip = level },
                { .name = "vct_texels", .buffer = texels->list },
                { .name = "vct_texel_counts", .buffer = texels->counts },
                vct_grid_binding(frame, 0)),
            &push, sizeof push, texels->counts, vct_level_groups(level));
    }
}

void vct_volume_fill(struct vct_volume *volume, const struct vct_frame *frame)
{
    struct gpu_cmd *cmd = frame->cmd;
    gpu_scope_begin(cmd, "fill");
    // Not earlier: bounced light is gathered from the volume of the previous frame.
    if (volume->outdated)
        gpu_clear_image(cmd, volume->light, (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    volume->outdated = false;
    for (int i = 0; i < frame->clipmap->count; i++) fill(volume, frame, i);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "mips");
    filter(volume, frame);
    gpu_scope_end(cmd);
}
