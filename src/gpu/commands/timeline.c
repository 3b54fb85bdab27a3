// Timeline semaphores: each counts the submissions of a queue. They tell which recordings the GPU
// has completed.
#include "gpu/vk.h"

bool timeline_create(struct gpu *gpu, struct queue *queue, const char *name)
{
    const VkSemaphoreTypeCreateInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
        .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE,
    };
    if (!VK_CALL(gpu, CreateSemaphore, gpu->device,
                 &(VkSemaphoreCreateInfo){ .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                           .pNext = &timeline },
                 gpu->allocator, &queue->timeline)) {
        queue->timeline = VK_NULL_HANDLE;
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_SEMAPHORE, queue->timeline, name);
    return true;
}

bool timeline_wait(struct gpu *gpu, const struct queue *queue, uint64_t value)
{
    if (gpu->lost || !queue->timeline) return false;
    return VK_CALL(gpu, WaitSemaphores, gpu->device,
                   &(VkSemaphoreWaitInfo){ .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                           .semaphoreCount = 1,
                                           .pSemaphores = &queue->timeline,
                                           .pValues = &value },
                   UINT64_MAX);
}

static bool wait_idle(struct gpu *gpu, const struct queue *queue)
{
    return queue->submitted == 0 || timeline_wait(gpu, queue, queue->submitted);
}

bool timeline_wait_all(struct gpu *gpu)
{
    const bool uploaded = wait_idle(gpu, &gpu->upload_queue);
    return wait_idle(gpu, &gpu->queue) && uploaded;
}

// Semaphore value up to which the GPU has completed the submissions.
static uint64_t completed_value(struct gpu *gpu, const struct queue *queue)
{
    uint64_t value = 0;
    if (queue->timeline &&
        gpu->vk.GetSemaphoreCounterValue(gpu->device, queue->timeline, &value) == VK_SUCCESS)
        return value;
    return gpu->lost ? UINT64_MAX : 0;
}

uint64_t timeline_completed_serial(struct gpu *gpu)
{
    const uint64_t rendered = completed_value(gpu, &gpu->queue);
    const uint64_t uploaded = completed_value(gpu, &gpu->upload_queue);
    uint64_t completed = gpu->serial;
    for (int i = 0; i < CMD_COUNT; i++) {
        struct gpu_cmd *cmd = &gpu->cmds[i];
        const uint64_t value = i == CMD_UPLOAD ? uploaded : rendered;
        if (cmd->state == CMD_PENDING && !cmd->adopted && cmd->timeline <= value) {
            cmd->state = CMD_FREE;
            scopes_collect(cmd);
        }
        if (cmd->state != CMD_FREE && cmd->serial <= completed) completed = cmd->serial - 1;
    }
    return completed;
}
