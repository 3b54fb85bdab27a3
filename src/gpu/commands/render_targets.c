// Targets of the open rendering, and its interruption by barriers.
#include "gpu/vk.h"

struct range render_target_range(const struct image *image, const struct gpu_target *target)
{
    uint32_t layer = image->desc.dimension == GPU_3D ? 0 : target->layer;
    return (struct range){ target->mip, 1, layer, 1 };
}

static bool is_target(const struct gpu_cmd *cmd, const struct gpu_target *target,
                      const struct image *image, const struct range *range)
{
    if (!target->image.id || image_get(cmd->gpu, target->image) != image) return false;
    struct range r = render_target_range(image, target);
    return r.mip >= range->mip && r.mip < range->mip + range->mip_count &&
           r.layer >= range->layer && r.layer < range->layer + range->layer_count;
}

bool render_has_target(const struct gpu_cmd *cmd, const struct image *image,
                       const struct range *range)
{
    const struct rendering *r = &cmd->rendering;
    if (!r->open || !(image->desc.usage & GPU_ATTACHMENT)) return false;
    for (int i = 0; i < r->color_count; i++) {
        if (is_target(cmd, &r->colors[i], image, range)) return true;
    }
    return is_target(cmd, &r->depth, image, range);
}

void render_suspend(struct gpu_cmd *cmd)
{
    if (!cmd->rendering.active) return;
    cmd->gpu->vk.CmdEndRendering(cmd->buffer);
    cmd->rendering.active = false;
}
