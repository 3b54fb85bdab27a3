#include "rendering.h"

enum ag_result rendering_open(struct rendering *rendering, const struct rendering_desc *desc)
{
    struct ag_renderer_desc renderer;
    ag_renderer_desc_default(&renderer);
    renderer.width = desc->width;
    renderer.height = desc->height;
    renderer.gi = desc->gi;
    renderer.frame_options = desc->frame_options;
    renderer.indirect_layer = true;
    renderer.id_layer = true;
    renderer.bakes = desc->bakes;
    renderer.bake_count = desc->bake_count;
    *rendering = (struct rendering){
        .gpu = desc->gpu, .context = desc->context, .width = desc->width, .height = desc->height
    };
    return ag_renderer_create(desc->device, desc->scene, &renderer, &rendering->renderer);
}

void rendering_close(struct rendering *rendering)
{
    rendering->shown.vk_image = NULL;
    ag_renderer_destroy(rendering->renderer);
    *rendering = (struct rendering){ 0 };
}

enum ag_result rendering_resize(struct rendering *rendering, int width, int height)
{
    rendering->shown.vk_image = NULL;
    const enum ag_result result = ag_renderer_resize(rendering->renderer, width, height);
    if (result != AG_OK) return result;
    rendering->width = width;
    rendering->height = height;
    return AG_OK;
}

enum ag_result rendering_render(struct rendering *rendering, const struct ag_frame_desc *frame)
{
    const enum ag_result result = ag_renderer_render(rendering->renderer, frame);
    if (result != AG_OK) return result;
    return ag_renderer_layer_handle(rendering->renderer, "display", &rendering->shown);
}

// The library's frame before, or the copy, and what follows it.
static void transition(VkCommandBuffer commands, VkImage image, VkImageLayout from,
                       VkImageLayout to)
{
    const VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 },
    };
    const VkDependencyInfo info = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &barrier };
    vkCmdPipelineBarrier2(commands, &info);
}

void rendering_draw(const struct rendering *rendering, struct swapchain *swapchain,
                    const float rectangle[4], float left, float right)
{
    const struct ag_layer_handle *shown = &rendering->shown;
    const VkCommandBuffer commands = swapchain->frames[swapchain->frame].commands;
    const float width = rectangle[2] - rectangle[0];
    const int x0 = (int)(left * (float)shown->width + 0.5f);
    const int x1 = (int)(right * (float)shown->width + 0.5f);
    if (!shown->vk_image || x0 >= x1) return;
    const VkImage image = ag_vulkan_image(shown);
    const VkImageLayout layout = ag_vulkan_layout(shown);
    // The edges of the part in the window are those of whole texels.
    const float u0 = (float)x0 / (float)shown->width, u1 = (float)x1 / (float)shown->width;
    const VkImageBlit region = {
        .srcSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .srcOffsets = { { x0, 0, 0 }, { x1, shown->height, 1 } },
        .dstSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .dstOffsets = { { (int)(rectangle[0] + u0 * width), (int)rectangle[1], 0 },
                        { (int)(rectangle[0] + u1 * width), (int)rectangle[3], 1 } },
    };
    transition(commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdBlitImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                   swapchain->images[swapchain->image], VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                   &region, VK_FILTER_LINEAR);
    transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
}
