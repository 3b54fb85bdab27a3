#include "techniques/vct/rays/rays.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_state.h"

static void pack_planes(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd,
                        const struct vct_voxel_set *set)
{
    gpu_dispatch_indirect(cmd, vct->planes,
                          GPU_BIND(vct_grid_binding(vct, clip, cmd),
                                   { .name = "vct_arguments", .buffer = set->arguments },
                                   { .name = "vct_surfaces", .image = set->surfaces },
                                   { .name = "vct_planes", .image = set->planes }),
                          NULL, 0, set->arguments, 0);
}

void vct_rays_list_blocks(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd)
{
    const struct vct_texels_push push =
        vct_texels_push(&vct->options, vct_volume_mips(&vct->options));
    gpu_scope_begin(cmd, "blocks");
    if (clip->new_statics) pack_planes(vct, clip, cmd, &clip->static_set);
    pack_planes(vct, clip, cmd, &clip->dynamic_set);
    gpu_dispatch(cmd, vct->blocks,
                 GPU_BIND(vct_grid_binding(vct, clip, cmd), VCT_RAY_BINDINGS(vct, clip),
                          { .name = "vct_texel_mask", .buffer = clip->texel_mask }),
                 &push, sizeof push,
                 gpu_groups((uint32_t)vct_mask_words(&vct->options), 2 * VCT_LOCAL), 1, 1);
    gpu_scope_end(cmd);
}
