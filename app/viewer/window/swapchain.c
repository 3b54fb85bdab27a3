#include "swapchain.h"

#include <string.h>

static const VkImageUsageFlags USAGE = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                       VK_IMAGE_USAGE_TRANSFER_DST_BIT;

// ---- formats

// 8-bit without conversion: the image and the interface are sRGB-encoded already.
static bool choose_format(struct swapchain *s)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    vkGetPhysicalDeviceSurfaceFormatsKHR(s->gpu->physical, s->gpu->surface, &count, formats);
    for (uint32_t i = 0; i < count; i++) {
        s->format = formats[i];
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
            formats[i].format == VK_FORMAT_R8G8B8A8_UNORM)
            return true;
    }
    return false;
}

static bool create_pass(struct swapchain *s)
{
    const VkAttachmentDescription attachment = {
        .format = s->format.format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };
    const VkAttachmentReference reference = { 0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL };
    const VkSubpassDescription subpass = { .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                           .colorAttachmentCount = 1,
                                           .pColorAttachments = &reference };
    // The image is drawn before, by transfers; a copy may follow.
    const VkSubpassDependency dependencies[] = {
        { .srcSubpass = VK_SUBPASS_EXTERNAL,
          .srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
          .dstStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
          .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
          .dstAccessMask =
              VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT },
        { .dstSubpass = VK_SUBPASS_EXTERNAL,
          .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
          .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
          .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
          .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT },
    };
    const VkRenderPassCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = 2,
        .pDependencies = dependencies,
    };
    return vkCreateRenderPass(s->gpu->device, &info, NULL, &s->pass) == VK_SUCCESS;
}

// ---- frames in flight

static bool create_frame(const struct gpu *gpu, struct swapchain_frame *frame)
{
    const VkCommandPoolCreateInfo pool = { .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = gpu->family };
    const VkSemaphoreCreateInfo semaphore = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    const VkFenceCreateInfo fence = { .sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                                      .flags = VK_FENCE_CREATE_SIGNALED_BIT };
    if (vkCreateCommandPool(gpu->device, &pool, NULL, &frame->pool) != VK_SUCCESS) return false;
    const VkCommandBufferAllocateInfo commands = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = frame->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    return vkAllocateCommandBuffers(gpu->device, &commands, &frame->commands) == VK_SUCCESS &&
           vkCreateSemaphore(gpu->device, &semaphore, NULL, &frame->acquired) == VK_SUCCESS &&
           vkCreateFence(gpu->device, &fence, NULL, &frame->done) == VK_SUCCESS;
}

// ---- images

static void destroy_images(struct swapchain *s)
{
    const VkDevice device = s->gpu->device;
    vkDeviceWaitIdle(device);
    for (uint32_t i = 0; i < s->count; i++) {
        vkDestroyFramebuffer(device, s->framebuffers[i], NULL);
        vkDestroyImageView(device, s->views[i], NULL);
        vkDestroySemaphore(device, s->rendered[i], NULL);
        s->framebuffers[i] = VK_NULL_HANDLE;
        s->views[i] = VK_NULL_HANDLE;
        s->rendered[i] = VK_NULL_HANDLE;
    }
    s->count = 0;
}

static bool create_image_objects(struct swapchain *s, uint32_t i)
{
    const VkDevice device = s->gpu->device;
    const VkSemaphoreCreateInfo semaphore = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO };
    const VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = s->images[i],
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = s->format.format,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 },
    };
    VkFramebufferCreateInfo framebuffer = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = s->pass,
        .attachmentCount = 1,
        .pAttachments = &s->views[i],
        .width = s->width,
        .height = s->height,
        .layers = 1,
    };
    return vkCreateImageView(device, &view, NULL, &s->views[i]) == VK_SUCCESS &&
           vkCreateFramebuffer(device, &framebuffer, NULL, &s->framebuffers[i]) == VK_SUCCESS &&
           vkCreateSemaphore(device, &semaphore, NULL, &s->rendered[i]) == VK_SUCCESS;
}

static VkExtent2D image_size(const VkSurfaceCapabilitiesKHR *surface, int width, int height)
{
    VkExtent2D size = surface->currentExtent;
    if (size.width != UINT32_MAX) return size;
    const VkExtent2D least = surface->minImageExtent, most = surface->maxImageExtent;
    size = (VkExtent2D){ (uint32_t)width, (uint32_t)height };
    if (size.width < least.width) size.width = least.width;
    if (size.height < least.height) size.height = least.height;
    if (size.width > most.width) size.width = most.width;
    if (size.height > most.height) size.height = most.height;
    return size;
}

static bool create_images(struct swapchain *s, int width, int height)
{
    const struct gpu *gpu = s->gpu;
    VkSurfaceCapabilitiesKHR surface;
    if (vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu->physical, gpu->surface, &surface) !=
            VK_SUCCESS ||
        (surface.supportedUsageFlags & USAGE) != USAGE)
        return false;
    const VkExtent2D size = image_size(&surface, width, height);
    if (size.width == 0 || size.height == 0) return true; // minimised: none until the next size
    uint32_t count = surface.minImageCount < 2 ? 2 : surface.minImageCount;
    if (surface.maxImageCount && count > surface.maxImageCount) count = surface.maxImageCount;
    s->least = count;
    const VkSwapchainKHR old = s->handle;
    const VkSwapchainCreateInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = gpu->surface,
        .minImageCount = count,
        .imageFormat = s->format.format,
        .imageColorSpace = s->format.colorSpace,
        .imageExtent = size,
        .imageArrayLayers = 1,
        .imageUsage = USAGE,
        .preTransform = surface.currentTransform,
        .compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR,
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = old,
    };
    const bool made = vkCreateSwapchainKHR(gpu->device, &info, NULL, &s->handle) == VK_SUCCESS;
    vkDestroySwapchainKHR(gpu->device, old, NULL);
    if (!made) s->handle = VK_NULL_HANDLE;
    if (!made) return false;
    s->width = size.width;
    s->height = size.height;
    uint32_t images = SWAPCHAIN_IMAGES;
    if (vkGetSwapchainImagesKHR(gpu->device, s->handle, &images, s->images) != VK_SUCCESS)
        return false; // also VK_INCOMPLETE
    for (s->count = 0; s->count < images;)
        if (!create_image_objects(s, s->count++)) return false;
    return true;
}

bool swapchain_open(struct swapchain *s, const struct gpu *gpu, int width, int height)
{
    memset(s, 0, sizeof *s);
    s->gpu = gpu;
    if (!choose_format(s) || !create_pass(s)) return false;
    for (int i = 0; i < SWAPCHAIN_FRAMES; i++)
        if (!create_frame(gpu, &s->frames[i])) return false;
    return create_images(s, width, height);
}

void swapchain_close(struct swapchain *s)
{
    if (!s->gpu || !s->gpu->device) return;
    const VkDevice device = s->gpu->device;
    destroy_images(s);
    for (int i = 0; i < SWAPCHAIN_FRAMES; i++) {
        vkDestroyFence(device, s->frames[i].done, NULL);
        vkDestroySemaphore(device, s->frames[i].acquired, NULL);
        vkDestroyCommandPool(device, s->frames[i].pool, NULL);
    }
    vkDestroySwapchainKHR(device, s->handle, NULL);
    vkDestroyRenderPass(device, s->pass, NULL);
    memset(s, 0, sizeof *s);
}

bool swapchain_resize(struct swapchain *s, int width, int height)
{
    s->stale = false;
    destroy_images(s);
    return create_images(s, width, height);
}

// ---- a frame

bool swapchain_begin(struct swapchain *s, VkCommandBuffer *commands)
{
    const VkDevice device = s->gpu->device;
    struct swapchain_frame *frame = &s->frames[s->frame];
    *commands = VK_NULL_HANDLE;
    if (s->loses_device) return false;
    if (!s->handle || !s->count || s->stale) return true;
    if (vkWaitForFences(device, 1, &frame->done, VK_TRUE, UINT64_MAX) != VK_SUCCESS) return false;
    const VkResult result = vkAcquireNextImageKHR(device, s->handle, UINT64_MAX, frame->acquired,
                                                  VK_NULL_HANDLE, &s->image);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) s->stale = true;
    if (result == VK_ERROR_OUT_OF_DATE_KHR) return true;
    if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR) return false;
    const VkCommandBufferBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                             .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT };
    if (vkResetCommandPool(device, frame->pool, 0) != VK_SUCCESS ||
        vkBeginCommandBuffer(frame->commands, &begin) != VK_SUCCESS)
        return false;
    *commands = frame->commands;
    return true;
}

static void transition(struct swapchain *s, VkImageLayout from, VkImageLayout to)
{
    gpu_transition(s->frames[s->frame].commands, s->images[s->image], from, to);
}

void swapchain_clear(struct swapchain *s)
{
    const VkClearColorValue color = { { 0.06f, 0.06f, 0.07f, 1.0f } };
    const VkImageSubresourceRange all = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
    transition(s, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdClearColorImage(s->frames[s->frame].commands, s->images[s->image],
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &all);
    // Copies overwrite parts of it.
    transition(s, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
}

void swapchain_pass_begin(struct swapchain *s)
{
    const VkRenderPassBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
        .renderPass = s->pass,
        .framebuffer = s->framebuffers[s->image],
        .renderArea = { { 0, 0 }, { s->width, s->height } },
    };
    vkCmdBeginRenderPass(s->frames[s->frame].commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

void swapchain_pass_end(struct swapchain *s)
{
    vkCmdEndRenderPass(s->frames[s->frame].commands);
}

void swapchain_copy(struct swapchain *s, VkBuffer to)
{
    const VkCommandBuffer commands = s->frames[s->frame].commands;
    const VkBufferImageCopy region = {
        .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .imageExtent = { s->width, s->height, 1 },
    };
    transition(s, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands, s->images[s->image], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                           1, &region);
    transition(s, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    const VkBufferMemoryBarrier host = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .buffer = to,
        .size = VK_WHOLE_SIZE,
    };
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 0,
                         NULL, 1, &host, 0, NULL);
}

bool swapchain_end(struct swapchain *s)
{
    const struct gpu *gpu = s->gpu;
    struct swapchain_frame *frame = &s->frames[s->frame];
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT; // swapchain_clear
    const VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &frame->acquired,
        .pWaitDstStageMask = &stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &frame->commands,
        .signalSemaphoreCount = 1,
        .pSignalSemaphores = &s->rendered[s->image],
    };
    if (vkEndCommandBuffer(frame->commands) != VK_SUCCESS ||
        vkResetFences(gpu->device, 1, &frame->done) != VK_SUCCESS ||
        vkQueueSubmit(gpu->queue, 1, &submit, frame->done) != VK_SUCCESS)
        return false;
    const VkPresentInfoKHR present = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &s->rendered[s->image],
        .swapchainCount = 1,
        .pSwapchains = &s->handle,
        .pImageIndices = &s->image,
    };
    const VkResult result = vkQueuePresentKHR(gpu->queue, &present);
    s->frame = (s->frame + 1) % SWAPCHAIN_FRAMES;
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) s->stale = true;
    return result == VK_SUCCESS || s->stale;
}
