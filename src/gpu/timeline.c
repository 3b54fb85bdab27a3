// The timeline semaphore: counts submissions, and tells which recordings the GPU has completed.
#include "gpu/vk.h"

bool timeline_wait(struct gpu *gpu, uint64_t value)
{
    if (gpu->lost || !gpu->timeline) return false;
    return VK_CALL(gpu, WaitSemaphores, gpu->device,
                   &(VkSemaphoreWaitInfo){ .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
                                           .semaphoreCount = 1,
                                           .pSemaphores = &gpu->timeline,
                                           .pValues = &value },
                   UINT64_MAX);
}

uint64_t timeline_completed_serial(struct gpu *gpu)
{
    uint64_t value = 0;
    if (!gpu->timeline ||
        gpu->vk.GetSemaphoreCounterValue(gpu->device, gpu->timeline, &value) != VK_SUCCESS) {
        value = gpu->lost ? UINT64_MAX : 0;
    }
    uint64_t completed = gpu->serial;
    for (int i = 0; i < CMD_COUNT; i++) {
        struct gpu_cmd *cmd = &gpu->cmds[i];
        if (cmd->state == CMD_PENDING && !cmd->adopted && cmd->timeline <= value) {
            cmd->state = CMD_FREE;
            scopes_collect(cmd);
        }
        if (cmd->state != CMD_FREE && cmd->serial <= completed) completed = cmd->serial - 1;
    }
    return completed;
}
