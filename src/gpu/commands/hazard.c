// Hazard tracking and barriers. The state of each buffer and each image subresource is its last
// write, the stages to which it is visible, the stages that read since, and its layout. Each access
// queues exactly the barriers that it needs:
//
//   read after write    the write is made visible, once for each stage
//   write after read    execution dependency only
//   write after write   the earlier write is made visible
//   layout transition   counts as a write, ordered after all of these
//
// The state holds across submissions, which one queue executes in order; upload_queue.c has the
// exception. Accesses within one operation (a
// dispatch, or all draws of a rendering) are not ordered among each other. Memory dependencies are
// merged into one VkMemoryBarrier2; only layout transitions need separate barriers.
#include "gpu/vk.h"

static const VkPipelineStageFlags2 SHADER_STAGES = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
                                                   VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
                                                   VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
static const VkPipelineStageFlags2 DEPTH_STAGES =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;

// All read accesses of a stage: a write is made visible to all of them at once, so that
// `hazard.visible` needs no access flags.
static VkAccessFlags2 reads_of(VkPipelineStageFlags2 stages)
{
    VkAccessFlags2 access = 0;
    if (stages & SHADER_STAGES) {
        access |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
                  VK_ACCESS_2_UNIFORM_READ_BIT;
    }
    if (stages & VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT) access |= VK_ACCESS_2_INDEX_READ_BIT;
    if (stages & VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT)
        access |= VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
    if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) access |= VK_ACCESS_2_TRANSFER_READ_BIT;
    if (stages & VK_PIPELINE_STAGE_2_HOST_BIT) access |= VK_ACCESS_2_HOST_READ_BIT;
    if (stages & DEPTH_STAGES) access |= VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    if (stages & VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT) {
        access |= VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT;
    }
    return access;
}

static VkAccessFlags2 writes_of(VkPipelineStageFlags2 stages)
{
    VkAccessFlags2 access = 0;
    if (stages & SHADER_STAGES) access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) access |= VK_ACCESS_2_TRANSFER_WRITE_BIT;
    if (stages & DEPTH_STAGES) access |= VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    if (stages & VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT) {
        access |= VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    }
    return access;
}

void hazard_next_op(struct gpu_cmd *cmd)
{
    cmd->op = ++cmd->gpu->ops;
}

void hazard_flush(struct gpu_cmd *cmd)
{
    struct batch *batch = &cmd->batch;
    bool memory = batch->memory.srcStageMask || batch->memory.dstStageMask;
    if (!memory && !batch->image_count) return;
    render_suspend(cmd);
    batch->memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    cmd->gpu->vk.CmdPipelineBarrier2(cmd->buffer, &(VkDependencyInfo){
                                                      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                                      .memoryBarrierCount = memory,
                                                      .pMemoryBarriers = &batch->memory,
                                                      .imageMemoryBarrierCount = batch->image_count,
                                                      .pImageMemoryBarriers = batch->images,
                                                  });
    batch->memory = (VkMemoryBarrier2){ 0 };
    batch->image_count = 0;
}

static bool overlap(const VkImageSubresourceRange *a, const struct range *b)
{
    return a->baseMipLevel < b->mip + b->mip_count && b->mip < a->baseMipLevel + a->levelCount &&
           a->baseArrayLayer < b->layer + b->layer_count &&
           b->layer < a->baseArrayLayer + a->layerCount;
}

// Barriers of one command are not ordered among each other: two transitions of one subresource need
// two commands.
static void batch_layout(struct gpu_cmd *cmd, const struct image *image, const struct range *range,
                         const struct hazard *h, VkPipelineStageFlags2 source,
                         const struct access *access)
{
    struct batch *batch = &cmd->batch;
    bool conflict = batch->image_count == BATCH_IMAGES;
    for (uint32_t i = 0; i < batch->image_count; i++) {
        conflict |= batch->images[i].image == image->handle &&
                    overlap(&batch->images[i].subresourceRange, range);
    }
    if (conflict) hazard_flush(cmd);
    batch->images[batch->image_count++] = (VkImageMemoryBarrier2){
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = source,
        .srcAccessMask = h->write_access,
        .dstStageMask = access->stages,
        .dstAccessMask = reads_of(access->stages) | (access->write ? writes_of(access->stages) : 0),
        .oldLayout = h->layout,
        .newLayout = access->layout,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->handle,
        .subresourceRange = { format_aspects(image->desc.format), range->mip, range->mip_count,
                              range->layer, range->layer_count },
    };
}

static void batch_memory(struct gpu_cmd *cmd, const struct hazard *h, VkPipelineStageFlags2 source,
                         const struct access *access)
{
    VkMemoryBarrier2 *memory = &cmd->batch.memory;
    memory->srcStageMask |= source;
    memory->srcAccessMask |= h->write_access;
    memory->dstStageMask |= access->stages;
    memory->dstAccessMask |=
        reads_of(access->stages) | (access->write ? writes_of(access->stages) : 0);
}

// image: NULL for a buffer.
static void use(struct gpu_cmd *cmd, struct hazard *h, const struct image *image,
                const struct range *range, const struct access *access)
{
    if (h->op == cmd->op && h->op_wrote) return; // within one operation
    bool transition = image && h->layout != access->layout;
    bool exclusive = access->write || transition;
    VkPipelineStageFlags2 source = 0;
    if (exclusive) {
        source = h->write_stages | h->read_stages;
    } else if (access->stages & ~h->visible) {
        source = h->write_stages;
    }
    if (transition) {
        batch_layout(cmd, image, range, h, source, access);
    } else if (source) {
        batch_memory(cmd, h, source, access);
    }
    if (exclusive) {
        *h = (struct hazard){
            .write_stages = access->stages,
            .write_access = access->write ? writes_of(access->stages) : 0,
            .visible = access->write ? 0 : access->stages,
            .read_stages = access->write ? 0 : access->stages,
            .layout = access->layout,
        };
    } else {
        h->visible |= access->stages;
        h->read_stages |= access->stages;
    }
    h->op = cmd->op;
    h->op_wrote = access->write;
}

static struct hazard *at(struct image *image, uint32_t mip, uint32_t layer)
{
    return &image->hazards[layer * image->desc.mips + mip];
}

static bool is_whole(const struct image *image, const struct range *range)
{
    return range->mip == 0 && range->mip_count == image->desc.mips && range->layer == 0 &&
           range->layer_count == image->layers;
}

static void split(struct image *image)
{
    uint32_t count = image->desc.mips * image->layers;
    for (uint32_t i = 1; i < count; i++) image->hazards[i] = image->hazards[0];
    image->whole = false;
}

// Merges the states of all subresources into a conservative one, if layout and operation agree.
static void join(struct image *image)
{
    uint32_t count = image->desc.mips * image->layers;
    struct hazard all = image->hazards[0];
    for (uint32_t i = 1; i < count; i++) {
        const struct hazard *h = &image->hazards[i];
        if (h->layout != all.layout || h->op != all.op || h->op_wrote != all.op_wrote) return;
        all.write_stages |= h->write_stages;
        all.write_access |= h->write_access;
        all.visible &= h->visible;
        all.read_stages |= h->read_stages;
    }
    image->hazards[0] = all;
    image->whole = true;
}

static void use_image(struct gpu_cmd *cmd, struct image *image, const struct range *range,
                      const struct access *access)
{
    struct range all = image_whole(image);
    bool part = !is_whole(image, range);
    // A partial read without transition may conservatively be tracked for the whole image.
    bool exclusive = access->write || image->hazards[0].layout != access->layout;
    if (image->whole && (!part || !exclusive)) {
        use(cmd, &image->hazards[0], image, &all, access);
        return;
    }
    if (image->whole) split(image);
    for (uint32_t layer = range->layer; layer < range->layer + range->layer_count; layer++) {
        for (uint32_t mip = range->mip; mip < range->mip + range->mip_count; mip++) {
            use(cmd, at(image, mip, layer), image, &(struct range){ mip, 1, layer, 1 }, access);
        }
    }
    if (!part) join(image);
}

VkImageLayout hazard_shader_layout(const struct image *image)
{
    if (image->desc.usage & GPU_STORAGE) return VK_IMAGE_LAYOUT_GENERAL;
    if (image->desc.usage & GPU_SAMPLED) return VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    return image->desc.format == GPU_D32F ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                          : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

VkImageLayout hazard_transfer_layout(const struct image *image, bool write)
{
    if (image->desc.usage & GPU_STORAGE) return VK_IMAGE_LAYOUT_GENERAL;
    return write ? VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
}

static void zero_image(struct gpu_cmd *cmd, struct image *image)
{
    uint64_t op = cmd->op;
    struct range range = image_whole(image);
    struct access access = { VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, true,
                             hazard_transfer_layout(image, true) };
    VkImageSubresourceRange all = { image->aspect, 0, image->desc.mips, 0, image->layers };
    image->zero_pending = false;
    hazard_next_op(cmd);
    use_image(cmd, image, &range, &access);
    hazard_flush(cmd);
    if (image->desc.format == GPU_D32F) {
        cmd->gpu->vk.CmdClearDepthStencilImage(cmd->buffer, image->handle, access.layout,
                                               &(VkClearDepthStencilValue){ 0 }, 1, &all);
    } else {
        cmd->gpu->vk.CmdClearColorImage(cmd->buffer, image->handle, access.layout,
                                        &(VkClearColorValue){ 0 }, 1, &all);
    }
    cmd->op = op;
}

static void zero_buffer(struct gpu_cmd *cmd, struct buffer *buffer)
{
    uint64_t op = cmd->op;
    struct access access = { .stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, .write = true };
    buffer->zero_pending = false;
    hazard_next_op(cmd);
    use(cmd, &buffer->hazard, NULL, NULL, &access);
    hazard_flush(cmd);
    render_suspend(cmd);
    cmd->gpu->vk.CmdFillBuffer(cmd->buffer, buffer->handle, 0, buffer->capacity, 0);
    cmd->op = op;
}

void hazard_image(struct gpu_cmd *cmd, struct image *image, const struct range *range,
                  const struct access *access)
{
    image->used |= cmd->queue == &cmd->gpu->queue;
    if (image->alias) alias_use(cmd, image);
    if (image->zero_pending) zero_image(cmd, image);
    use_image(cmd, image, range, access);
}

void hazard_buffer(struct gpu_cmd *cmd, struct buffer *buffer, const struct access *access)
{
    if (buffer->constant) return;
    buffer->used |= cmd->queue == &cmd->gpu->queue;
    if (buffer->zero_pending) zero_buffer(cmd, buffer);
    use(cmd, &buffer->hazard, NULL, NULL, access);
}

void hazard_overwrite_image(struct image *image)
{
    image->zero_pending = false;
}

void hazard_overwrite_buffer(struct buffer *buffer)
{
    buffer->zero_pending = false;
}

// The GPU has completed all accesses of the earlier object. The redundant barrier is for
// synchronization validation, which does not track host waits; it costs one barrier per object.
struct hazard hazard_recycled(void)
{
    return (struct hazard){
        .write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .write_access = VK_ACCESS_2_MEMORY_WRITE_BIT,
    };
}

void hazard_external_use(struct image *image, VkImageLayout layout)
{
    image->whole = true;
    image->hazards[0] = hazard_recycled();
    image->hazards[0].layout = layout;
}
