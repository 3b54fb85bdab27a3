#include "techniques/vct/volume/volume.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

void vct_volume_list_texels(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    // Levels beyond the first have no mips; the blocks of lighting/bounce.comp are texels of one.
    const uint32_t levels = clip == &vct->clips[0] ? vct_volume_mips(&vct->options)
                                                   : vct_block_level(&vct->options) + 1;
    const struct vct_texels_push push = vct_texels_push(&vct->options, levels);
    const size_t counts = offsetof(struct vct_texel_levels, count);
    gpu_scope_begin(cmd, "texels");
    // At least one group each: a dispatch is never empty.
    gpu_fill_buffer(cmd, clip->texel_counts, 0, counts, 1);
    gpu_fill_buffer(cmd, clip->texel_counts, counts, sizeof(struct vct_texel_levels) - counts, 0);
    gpu_fill_buffer(cmd, clip->texel_mask, 0, gpu_buffer_bytes(vct->gpu, clip->texel_mask), 0);
    gpu_dispatch(
        cmd, vct->texel_lists,
        GPU_BIND(vct_grid_binding(vct, clip, cmd),
                 { .name = "static_mask", .buffer = clip->static_set.mask },
                 { .name = "dynamic_mask", .buffer = clip->dynamic_set.mask },
                 { .name = "vct_texel_mask", .buffer = clip->texel_mask },
                 { .name = "vct_texels", .buffer = clip->texels },
                 { .name = "vct_texel_counts", .buffer = clip->texel_counts }),
        &push, sizeof push,
        gpu_groups((uint32_t)vct_mask_words(&vct->options), 2 * VCT_TEXELS_EACH * VCT_LOCAL), 1, 1);
    vct->light_outdated = true;
    gpu_scope_end(cmd);
}

static void fill(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    gpu_dispatch_indirect(cmd, vct->fill[vct->moving_draws > 0],
                          GPU_BIND(vct_grid_binding(vct, clip, cmd), VCT_BOTH_SETS(clip),
                                   { .name = "light", .image = vct->light },
                                   { .name = "vct_texels", .buffer = clip->texels },
                                   { .name = "vct_texel_counts", .buffer = clip->texel_counts }),
                          NULL, 0, clip->texel_counts, vct_level_groups(0));
}

// Texels of a mip that are in use, rounded up.
static int32_t mip_size(int32_t cells, uint32_t level)
{
    const int32_t size = (cells / 2 + (1 << level) - 1) >> level;
    return size > 1 ? size : 1;
}

static void filter(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    const struct vct_texels_push lists =
        vct_texels_push(&vct->options, vct_volume_mips(&vct->options));
    const int32_t dim = (int32_t)vct_volume_dim(&vct->options), *cells = clip->grid.cells;
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
            cmd, vct->mip,
            GPU_BIND({ .name = "source", .image = vct->light, .mip = level - 1, .one_mip = true },
                     { .name = "target", .image = vct->light, .mip = level },
                     { .name = "vct_texels", .buffer = clip->texels },
                     { .name = "vct_texel_counts", .buffer = clip->texel_counts },
                     vct_grid_binding(vct, clip, cmd)),
            &push, sizeof push, clip->texel_counts, vct_level_groups(level));
    }
}

void vct_volume_fill(struct vct *vct, struct gpu_cmd *cmd)
{
    gpu_scope_begin(cmd, "fill");
    // Not earlier: bounced light is gathered from the volume of the previous frame.
    if (vct->light_outdated)
        gpu_clear_image(cmd, vct->light, (const float[4]){ 0.0f, 0.0f, 0.0f, 0.0f });
    vct->light_outdated = false;
    for (int i = 0; i < vct->clip_count; i++) {
        fill(vct, &vct->clips[i], cmd);
        vct->clips[i].lit_grid = vct->clips[i].grid;
    }
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "mips");
    filter(vct, &vct->clips[0], cmd);
    gpu_scope_end(cmd);
}
