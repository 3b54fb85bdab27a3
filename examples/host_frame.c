#include "host_frame.h"

#include <string.h>

void host_frame_create(const struct host_device *host, struct host_frame *out)
{
    VkCommandPoolCreateInfo pool;
    memset(&pool, 0, sizeof pool);
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = host->family;
    host_check(vkCreateCommandPool(host->device, &pool, NULL, &out->pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate;
    memset(&allocate, 0, sizeof allocate);
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = out->pool;
    allocate.commandBufferCount = 1;
    host_check(vkAllocateCommandBuffers(host->device, &allocate, &out->commands), "commands");
    VkFenceCreateInfo fence;
    memset(&fence, 0, sizeof fence);
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    host_check(vkCreateFence(host->device, &fence, NULL, &out->fence), "vkCreateFence");
}

void host_frame_destroy(const struct host_device *host, const struct host_frame *frame)
{
    vkDestroyFence(host->device, frame->fence, NULL);
    vkDestroyCommandPool(host->device, frame->pool, NULL);
}

void host_frame_begin(const struct host_frame *frame)
{
    VkCommandBufferBeginInfo begin;
    memset(&begin, 0, sizeof begin);
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    host_check(vkBeginCommandBuffer(frame->commands, &begin), "vkBeginCommandBuffer");
}

void host_frame_submit(const struct host_device *host, const struct host_frame *frame)
{
    host_check(vkEndCommandBuffer(frame->commands), "vkEndCommandBuffer");
    VkSubmitInfo submit;
    memset(&submit, 0, sizeof submit);
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &frame->commands;
    host_check(vkQueueSubmit(host->queue, 1, &submit, frame->fence), "vkQueueSubmit");
}

void host_frame_wait(const struct host_device *host, const struct host_frame *frame)
{
    host_check(vkWaitForFences(host->device, 1, &frame->fence, VK_TRUE, UINT64_MAX), "frame");
    host_check(vkResetFences(host->device, 1, &frame->fence), "vkResetFences");
}
