#include "techniques/vct/rays/rays.h"

#include "techniques/vct/vct_bindings.h"
#include "techniques/vct/vct_frame.h"

static void pack_planes(const struct vct_rays *rays, const struct vct_frame *frame, int level,
                        const struct vct_voxel_set *set, gpu_image planes)
{
    gpu_dispatch_indirect(frame->cmd, rays->planes,
                          GPU_BIND(vct_grid_binding(frame, level),
                                   { .name = "vct_arguments", .buffer = set->arguments },
                                   { .name = "vct_surfaces", .image = set->surfaces },
                                   { .name = "vct_planes", .image = planes }),
                          NULL, 0, set->arguments, 0);
}

void vct_rays_list_blocks(const struct vct_rays *rays, const struct vct_frame *frame, int level)
{
    const struct vct_options *options = frame->options;
    const struct vct_level_voxels *voxels = &frame->voxels->levels[level];
    const struct vct_texels_push push = vct_texels_push(options, vct_volume_mips(options));
    gpu_scope_begin(frame->cmd, "blocks");
    const gpu_image *planes = frame->voxels->planes;
    if (voxels->new_statics) pack_planes(rays, frame, level, &voxels->static_set, planes[0]);
    pack_planes(rays, frame, level, &voxels->dynamic_set, planes[1]);
    gpu_dispatch(
        frame->cmd, rays->blocks,
        GPU_BIND(vct_grid_binding(frame, level), VCT_RAY_BINDINGS(frame), VCT_BOTH_SETS(voxels),
                 { .name = "vct_texel_mask", .buffer = frame->volume->levels[level].mask }),
        &push, sizeof push, gpu_groups((uint32_t)vct_mask_words(options), 2 * VCT_LOCAL), 1, 1);
    gpu_scope_end(frame->cmd);
}
