#include "rendering.h"

#include "viewer/window/blit.h"

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

// The window's newest frame may still copy from the image.
static void forget_shown(struct rendering *rendering)
{
    if (rendering->shown.vk_image) vkDeviceWaitIdle(rendering->gpu->device);
    rendering->shown.vk_image = NULL;
}

void rendering_close(struct rendering *rendering)
{
    forget_shown(rendering);
    ag_renderer_destroy(rendering->renderer);
    *rendering = (struct rendering){ 0 };
}

enum ag_result rendering_resize(struct rendering *rendering, int width, int height)
{
    forget_shown(rendering);
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

void rendering_draw(const struct rendering *rendering, struct swapchain *swapchain,
                    const float rectangle[4], float left, float right)
{
    const struct ag_layer_handle *shown = &rendering->shown;
    const VkCommandBuffer commands = swapchain->frames[swapchain->frame].commands;
    if (!shown->vk_image) return;
    const VkImage image = ag_vulkan_image(shown);
    const VkImageLayout layout = ag_vulkan_layout(shown);
    gpu_transition(commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    blit_part(swapchain, image, shown->width, shown->height, rectangle, left, right);
    gpu_transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
}
