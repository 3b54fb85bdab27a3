// Frames and transfers: recording, submission and waiting. Two frames are in flight. Deferred
// deletion refers to the serial number of recordings.
#include "gpu/vk.h"

#include <stdio.h>
#include <string.h>

bool cmd_init(struct gpu *gpu, struct gpu_cmd *cmd, bool adopted)
{
    const bool frame = adopted || cmd < &gpu->cmds[CMD_TRANSFER];
    cmd->gpu = gpu;
    cmd->queue = cmd == &gpu->cmds[CMD_UPLOAD] ? &gpu->upload_queue : &gpu->queue;
    cmd->adopted = adopted;
    char name[32];
    snprintf(name, sizeof name, "gpu.commands %d", (int)(cmd - gpu->cmds));
    if (frame && !scopes_init(gpu, &cmd->scopes, name)) return false;
    if (adopted || !cmd->queue->handle) return true;
    if (!VK_CALL(gpu, CreateCommandPool, gpu->device,
                 &(VkCommandPoolCreateInfo){ .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                             .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                             .queueFamilyIndex = gpu->queue_family },
                 gpu->allocator, &cmd->pool)) {
        cmd->pool = VK_NULL_HANDLE;
        return false;
    }
    if (!VK_CALL(
            gpu, AllocateCommandBuffers, gpu->device,
            &(VkCommandBufferAllocateInfo){ .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                            .commandPool = cmd->pool,
                                            .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                            .commandBufferCount = 1 },
            &cmd->buffer)) {
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_COMMAND_BUFFER, cmd->buffer, name);
    return true;
}

void cmd_finish(struct gpu *gpu, struct gpu_cmd *cmd)
{
    gpu->vk.DestroyQueryPool(gpu->device, cmd->scopes.queries, gpu->allocator);
    gpu->vk.DestroyCommandPool(gpu->device, cmd->pool, gpu->allocator);
    ring_finish(cmd);
    *cmd = (struct gpu_cmd){ 0 };
}

// Resets the state of images that the caller may have used since the previous recording. The upload
// queue uses none of them.
static void reset_shared(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    if (cmd->queue != &gpu->queue) return;
    for (uint32_t i = 0; i < gpu->images.count; i++) {
        struct image *image = gpu->images.objects[i];
        if (image && image->shared && !image->zero_pending)
            hazard_external_use(image, image->hazards[0].layout);
    }
}

// Transitions shared images to the layout that gpu_image_handle returns.
static void unify_shared(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    if (cmd->queue != &gpu->queue) return;
    hazard_next_op(cmd);
    for (uint32_t i = 0; i < gpu->images.count; i++) {
        struct image *image = gpu->images.objects[i];
        if (!image || !image->shared || image->zero_pending) continue;
        if (image->whole && image->hazards[0].layout == hazard_shader_layout(image)) continue;
        struct range range = image_whole(image);
        hazard_image(cmd, image, &range,
                     &(struct access){ .stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                       .layout = hazard_shader_layout(image) });
    }
    hazard_flush(cmd);
}

static void start(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    cmd->state = CMD_RECORDING;
    cmd->serial = ++gpu->serial;
    cmd->client = gpu->client;
    cmd->broken = false;
    cmd->batch = (struct batch){ 0 };
    cmd->rendering = (struct rendering){ 0 };
    memset(cmd->bound, 0, sizeof cmd->bound);
    gpu->recording = cmd;
    reset_shared(cmd);
}

static bool start_own(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    if (!VK_CALL(gpu, ResetCommandPool, gpu->device, cmd->pool, 0) ||
        !VK_CALL(
            gpu, BeginCommandBuffer, cmd->buffer,
            &(VkCommandBufferBeginInfo){ .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT })) {
        return false;
    }
    start(cmd);
    return true;
}

static bool submit(struct gpu_cmd *cmd)
{
    struct gpu *gpu = cmd->gpu;
    gpu->recording = NULL;
    cmd->state = CMD_FREE;
    if (!VK_CALL(gpu, EndCommandBuffer, cmd->buffer)) return false;
    if (!queue_submit(gpu, cmd->queue, cmd->buffer)) return false;
    cmd->timeline = cmd->queue->submitted;
    cmd->state = CMD_PENDING;
    return true;
}

static bool may_record(struct gpu *gpu, const char *what)
{
    if (gpu->lost) return host_fail(gpu->host, FAIL_DEVICE, "gpu %s: the device was lost", what);
    if (!gpu->recording) return true;
    return host_fail(gpu->host, FAIL_ARGUMENT, "gpu %s: a frame is being recorded", what);
}

struct gpu_cmd *gpu_frame_begin(struct gpu *gpu)
{
    if (!may_record(gpu, "frame")) return NULL;
    struct gpu_cmd *cmd = &gpu->cmds[gpu->next_frame];
    if (cmd->state == CMD_PENDING && !timeline_wait(gpu, cmd->queue, cmd->timeline)) return NULL;
    deferred_delete_collect(gpu);
    if (!start_own(cmd)) return NULL;
    gpu->next_frame = (gpu->next_frame + 1) % GPU_FRAMES_IN_FLIGHT;
    ring_start(cmd);
    scopes_start(cmd);
    return cmd;
}

static void close_recording(struct gpu_cmd *cmd)
{
    if (cmd->rendering.open) {
        gpu_misuse(cmd->gpu, "frame: a rendering is still open at its end");
        gpu_render_end(cmd);
    }
    unify_shared(cmd);
    ring_stop(cmd);
    scopes_stop(cmd);
}

bool gpu_frame_end(struct gpu *gpu, struct gpu_cmd *cmd)
{
    if (!cmd || cmd != gpu->recording) return gpu_misuse(gpu, "frame: it is not being recorded");
    close_recording(cmd);
    gpu->counters.frames++;
    bool broken = cmd->broken;
    if (cmd->adopted) {
        cmd->state = CMD_PENDING; // until gpu_frame_adopted_done
        gpu->recording = NULL;
    } else if (!submit(cmd)) {
        return false;
    }
    return !broken && !gpu->lost;
}

struct gpu_cmd *gpu_frame_begin_adopted(struct gpu *gpu, void *vk_command_buffer)
{
    if (!may_record(gpu, "adopted frame")) return NULL;
    deferred_delete_collect(gpu);
    for (int i = CMD_ADOPTED; i < CMD_COUNT; i++) {
        struct gpu_cmd *cmd = &gpu->cmds[i];
        if (cmd->state != CMD_FREE) continue;
        if (!queue_join_uploads(gpu)) return NULL; // the caller's submission cannot wait for it
        cmd->buffer = vk_command_buffer;
        start(cmd);
        ring_start(cmd);
        scopes_start(cmd);
        return cmd;
    }
    host_fail(gpu->host, FAIL_ARGUMENT,
              "gpu adopted frame: %d are unfinished (gpu_frame_adopted_done)",
              (int)GPU_ADOPTED_FRAMES);
    return NULL;
}

void gpu_frame_adopted_done(struct gpu *gpu, struct gpu_cmd *cmd)
{
    if (!cmd || !cmd->adopted || cmd->state == CMD_FREE) {
        gpu_misuse(gpu, "adopted frame: it is none, or done already");
        return;
    }
    if (cmd == gpu->recording) {
        gpu_misuse(gpu, "adopted frame: gpu_frame_end comes before its submission");
        gpu->recording = NULL;
    } else {
        scopes_collect(cmd);
    }
    cmd->state = CMD_FREE;
    cmd->buffer = VK_NULL_HANDLE;
    deferred_delete_collect(gpu);
}

bool gpu_wait(struct gpu *gpu)
{
    bool done = timeline_wait_all(gpu);
    deferred_delete_collect(gpu);
    return done && !gpu->lost;
}

static struct gpu_cmd *transfer_start(struct gpu *gpu, bool upload_queue)
{
    struct gpu_cmd *cmd = &gpu->cmds[upload_queue ? CMD_UPLOAD : CMD_TRANSFER];
    if (!may_record(gpu, "transfer") || !start_own(cmd)) return NULL;
    hazard_next_op(cmd);
    return cmd;
}

struct gpu_cmd *transfer_begin(struct gpu *gpu)
{
    return transfer_start(gpu, false);
}

struct gpu_cmd *transfer_begin_image(struct gpu *gpu, const struct image *image)
{
    return transfer_start(gpu, upload_queue_takes_image(gpu, image));
}

struct gpu_cmd *transfer_begin_buffer(struct gpu *gpu, const struct buffer *buffer)
{
    return transfer_start(gpu, upload_queue_takes_buffer(gpu, buffer));
}

bool transfer_end(struct gpu *gpu, struct gpu_cmd *cmd)
{
    unify_shared(cmd);
    gpu->counters.transfers++;
    gpu->counters.upload_queue_transfers += cmd->queue == &gpu->upload_queue;
    bool done = submit(cmd) && timeline_wait(gpu, cmd->queue, cmd->timeline);
    deferred_delete_collect(gpu);
    return done;
}
