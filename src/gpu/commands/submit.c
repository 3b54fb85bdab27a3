// Submissions to both queues, under the caller's lock. Each signals the next value of its queue's
// timeline; the first one to the main queue after uploads waits for theirs (upload_queue.c).
#include "gpu/vk.h"

static VkSemaphoreSubmitInfo point(const struct queue *queue, uint64_t value)
{
    return (VkSemaphoreSubmitInfo){ .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
                                    .semaphore = queue->timeline,
                                    .value = value,
                                    .stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT };
}

static VkResult submit_locked(struct gpu *gpu, const struct queue *queue, const VkSubmitInfo2 *info)
{
    if (gpu->adopt.lock_queue) gpu->adopt.lock_queue(gpu->adopt.user);
    VkResult result = gpu->vk.QueueSubmit2(queue->handle, 1, info, VK_NULL_HANDLE);
    if (gpu->adopt.unlock_queue) gpu->adopt.unlock_queue(gpu->adopt.user);
    return result;
}

bool queue_submit(struct gpu *gpu, struct queue *queue, VkCommandBuffer commands)
{
    const bool join = queue == &gpu->queue && upload_queue_is_ahead(gpu);
    const VkSemaphoreSubmitInfo wait = point(&gpu->upload_queue, gpu->upload_queue.submitted);
    const VkSemaphoreSubmitInfo signal = point(queue, queue->submitted + 1);
    const VkCommandBufferSubmitInfo buffer = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
        .commandBuffer = commands,
    };
    const VkSubmitInfo2 info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
        .waitSemaphoreInfoCount = join,
        .pWaitSemaphoreInfos = &wait,
        .commandBufferInfoCount = commands != VK_NULL_HANDLE,
        .pCommandBufferInfos = &buffer,
        .signalSemaphoreInfoCount = 1,
        .pSignalSemaphoreInfos = &signal,
    };
    if (!vk_check(gpu, submit_locked(gpu, queue, &info), "vkQueueSubmit2")) return false;
    queue->submitted = signal.value;
    if (join) gpu->joined = wait.value;
    return true;
}

bool queue_join_uploads(struct gpu *gpu)
{
    return !upload_queue_is_ahead(gpu) || queue_submit(gpu, &gpu->queue, VK_NULL_HANDLE);
}
