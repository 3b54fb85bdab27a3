// Images that a caller's commands use, too: the library's, and the caller's own.
#include "gpu/vk.h"

// Zeroes a new image; transfer_end brings all shared images into their layout. The caller's next
// commands may use the image, also after an upload.
static bool settle(struct gpu *gpu, struct image *image)
{
    const VkImageLayout layout = hazard_shader_layout(image);
    if (!image->zero_pending && image->whole && image->hazards[0].layout == layout)
        return queue_join_uploads(gpu);
    struct gpu_cmd *cmd = transfer_begin(gpu);
    if (!cmd) return false;
    struct range range = image_whole(image);
    hazard_image(
        cmd, image, &range,
        &(struct access){ .stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, .layout = layout });
    hazard_flush(cmd);
    return transfer_end(gpu, cmd);
}

bool gpu_image_share(struct gpu *gpu, gpu_image handle, struct gpu_image_handles *out)
{
    struct image *image = image_get(gpu, handle);
    *out = (struct gpu_image_handles){ 0 };
    if (!image) return host_fail(gpu->host, FAIL_ARGUMENT, "gpu share: there is no such image");
    const struct range range = image_whole(image);
    const VkImageViewType type =
        image->desc.dimension == GPU_3D ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
    VkImageView view = image_view(gpu, image, type, &range);
    if (!view || !settle(gpu, image)) return false;
    image->shared = true;
    *out = (struct gpu_image_handles){
        .image = (void *)image->handle,
        .view = (void *)view,
        .format = (uint32_t)format_of(image->desc.format)->vk,
        .usage = image_usage(&image->desc),
        .layout = (uint32_t)hazard_shader_layout(image),
    };
    return true;
}

bool gpu_image_import(struct gpu *gpu, const struct gpu_image_desc *desc,
                      const struct gpu_image_handles *handles, gpu_image *out)
{
    const struct format *format = format_of(desc->format);
    const uint32_t layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    out->id = 0;
    if (handles->format != (uint32_t)format->vk)
        return host_fail(gpu->host, FAIL_ARGUMENT, "%s: its VkFormat is %u, not %u (%s)",
                         desc->name, handles->format, (unsigned)format->vk, format->name);
    if (!(handles->usage & VK_IMAGE_USAGE_SAMPLED_BIT))
        return host_fail(gpu->host, FAIL_ARGUMENT, "%s: its usage lacks VK_IMAGE_USAGE_SAMPLED_BIT",
                         desc->name);
    if (handles->layout != layout)
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "%s: its VkImageLayout is %u, not SHADER_READ_ONLY_OPTIMAL (%u)",
                         desc->name, handles->layout, layout);
    return gpu_image_wrap(gpu, desc, handles->image, layout, out);
}
