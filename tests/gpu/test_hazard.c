// Queued barriers, checked directly: a driver that executes in order would hide a missing one.
#include "framework/gpu_test.h"

#include "core/rng.h"
#include "gpu/vk.h"

static const VkPipelineStageFlags2 COMPUTE = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
static const VkPipelineStageFlags2 FRAGMENT = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
static const VkPipelineStageFlags2 TRANSFER = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
static const VkPipelineStageFlags2 INDIRECT = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
static const VkPipelineStageFlags2 COLOR = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;

// The barrier that one access to the buffer queues; records nothing.
static VkMemoryBarrier2 use(struct gpu_cmd *cmd, struct buffer *buffer,
                            VkPipelineStageFlags2 stages, bool write)
{
    hazard_next_op(cmd);
    hazard_buffer(cmd, buffer, &(struct access){ .stages = stages, .write = write });
    VkMemoryBarrier2 barrier = cmd->batch.memory;
    cmd->batch = (struct batch){ 0 };
    return barrier;
}

static struct buffer *new_buffer(struct gpu *gpu, gpu_buffer *handle)
{
    *handle = test_gpu_buffer(gpu, 64);
    struct buffer *buffer = buffer_get(gpu, *handle);
    hazard_overwrite_buffer(buffer);
    buffer->hazard = (struct hazard){ 0 };
    return buffer;
}

TEST_GPU(a_read_waits_once_for_a_write_in_each_stage)
{
    gpu_buffer handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct buffer *buffer = new_buffer(gpu, &handle);
    assert_int_equal(use(cmd, buffer, COMPUTE, true).dstStageMask,
                     0); // the first use waits for nothing
    VkMemoryBarrier2 barrier = use(cmd, buffer, INDIRECT, false);
    assert_int_equal(barrier.srcStageMask, COMPUTE);
    assert_int_equal(barrier.srcAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    assert_int_equal(barrier.dstStageMask, INDIRECT);
    assert_int_equal(barrier.dstAccessMask, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT);
    assert_int_equal(use(cmd, buffer, INDIRECT, false).dstStageMask, 0);
    assert_int_equal(use(cmd, buffer, FRAGMENT, false).srcStageMask, COMPUTE);
    assert_int_equal(use(cmd, buffer, FRAGMENT | INDIRECT, false).dstStageMask, 0);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_buffer_destroy(gpu, &handle);
}

TEST_GPU(a_write_waits_for_all_reads)
{
    gpu_buffer handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct buffer *buffer = new_buffer(gpu, &handle);
    use(cmd, buffer, TRANSFER, true);
    use(cmd, buffer, COMPUTE, false);
    use(cmd, buffer, FRAGMENT, false);
    VkMemoryBarrier2 barrier = use(cmd, buffer, COMPUTE, true);
    assert_int_equal(barrier.srcStageMask & (COMPUTE | FRAGMENT), COMPUTE | FRAGMENT);
    assert_int_equal(barrier.dstStageMask, COMPUTE);
    barrier = use(cmd, buffer, COMPUTE, true); // write after write
    assert_int_equal(barrier.srcStageMask, COMPUTE);
    assert_int_equal(barrier.srcAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    assert_true(barrier.dstAccessMask & VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_buffer_destroy(gpu, &handle);
}

// An earlier access and its execution and memory dependencies (Vulkan 1.3, sections 7.1 to 7.3).
struct event {
    VkPipelineStageFlags2 stage, after; // stages ordered after it
    VkPipelineStageFlags2 visible;      // writes: stages to which it is visible
    bool write, available;
};

static void apply(struct event *events, int count, const VkMemoryBarrier2 *barrier)
{
    for (int i = 0; i < count; i++) {
        struct event *e = &events[i];
        if (!((e->stage | e->after) & barrier->srcStageMask)) continue;
        bool own = e->stage & barrier->srcStageMask;
        if (e->write && own && barrier->srcAccessMask) e->available = true;
        e->after |= barrier->dstStageMask;
        if (e->available) e->visible |= barrier->dstStageMask;
    }
}

static bool is_safe(const struct event *events, int count, VkPipelineStageFlags2 stage, bool write)
{
    for (int i = 0; i < count; i++) {
        const struct event *e = &events[i];
        if (e->write && (stage & ~e->visible)) return false;
        if (!e->write && write && (stage & ~e->after)) return false;
    }
    return true;
}

TEST_GPU(barriers_match_a_model_of_the_specification)
{
    enum { STEPS = 4000, WINDOW = 64 };
    const VkPipelineStageFlags2 stages[] = { COMPUTE, FRAGMENT, TRANSFER, INDIRECT };
    struct event events[WINDOW];
    int count = 0, waits = 0;
    gpu_buffer handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct buffer *buffer = new_buffer(gpu, &handle);
    struct rng rng = rng_for(1, 2, 3);
    for (int step = 0; step < STEPS; step++) {
        VkPipelineStageFlags2 stage = stages[rng_u32(&rng) % 4];
        bool write = stage != INDIRECT && rng_u32(&rng) % 4 == 0;
        bool safe_before = is_safe(events, count, stage, write);
        VkMemoryBarrier2 barrier = use(cmd, buffer, stage, write);
        bool waited = barrier.srcStageMask != 0;
        apply(events, count, &barrier);
        waits += waited;
        assert_true(is_safe(events, count, stage, write)); // no barrier is missing
        if (safe_before && !write) assert_false(waited);   // no read waits needlessly
        if (write || count == WINDOW)
            count = write ? 0 : count - 1; // later accesses wait for the write
        events[count++] = (struct event){ .stage = stage, .write = write };
    }
    assert_true(waits > STEPS / 4 && waits < STEPS);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_buffer_destroy(gpu, &handle);
}

TEST_GPU(two_bindings_of_one_dispatch_do_not_wait_for_each_other)
{
    gpu_buffer handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct buffer *buffer = new_buffer(gpu, &handle);
    hazard_next_op(cmd);
    hazard_buffer(cmd, buffer, &(struct access){ .stages = COMPUTE, .write = true });
    hazard_buffer(cmd, buffer, &(struct access){ .stages = COMPUTE });
    assert_int_equal(cmd->batch.memory.dstStageMask, 0);
    // The next dispatch waits, although it reads in the same stage.
    assert_int_equal(use(cmd, buffer, COMPUTE, false).srcStageMask, COMPUTE);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_buffer_destroy(gpu, &handle);
}

static struct batch use_image(struct gpu_cmd *cmd, struct image *image, struct range range,
                              VkPipelineStageFlags2 stages, bool write, VkImageLayout layout)
{
    hazard_next_op(cmd);
    hazard_image(cmd, image, &range, &(struct access){ stages, write, layout });
    struct batch batch = cmd->batch;
    cmd->batch = (struct batch){ 0 };
    return batch;
}

static struct image *new_image(struct gpu *gpu, gpu_image *handle, uint32_t layers, uint32_t mips,
                               uint32_t usage)
{
    *handle = test_gpu_image(gpu, GPU_2D_ARRAY, GPU_RGBA16F, 16, 16, layers, mips, usage);
    struct image *image = image_get(gpu, *handle);
    hazard_overwrite_image(image);
    image->hazards[0] = (struct hazard){ 0 };
    return image;
}

TEST_GPU(transitions_cover_only_subresources_whose_layout_changes)
{
    const VkImageLayout target = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                        texture = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    gpu_image handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct image *image = new_image(gpu, &handle, 2, 3, GPU_SAMPLED | GPU_ATTACHMENT);
    const struct range all = image_whole(image), part = { 1, 1, 1, 1 };
    struct batch batch = use_image(cmd, image, all, FRAGMENT, false, texture);
    assert_int_equal(batch.image_count, 1);
    assert_int_equal(batch.images[0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
    assert_int_equal(batch.images[0].subresourceRange.levelCount, 3);
    assert_int_equal(batch.images[0].subresourceRange.layerCount, 2);
    batch = use_image(cmd, image, part, COLOR, true, target);
    assert_int_equal(batch.image_count, 1);
    assert_int_equal(batch.images[0].subresourceRange.baseMipLevel, 1);
    assert_int_equal(batch.images[0].subresourceRange.levelCount, 1);
    assert_int_equal(batch.images[0].subresourceRange.baseArrayLayer, 1);
    assert_int_equal(batch.images[0].srcStageMask, FRAGMENT); // it was read there
    assert_false(image->whole);
    // Back: transitions one mip and waits for its write.
    batch = use_image(cmd, image, all, FRAGMENT, false, texture);
    assert_int_equal(batch.image_count, 1);
    assert_int_equal(batch.images[0].srcAccessMask, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
    assert_int_equal(batch.images[0].newLayout, texture);
    batch = use_image(cmd, image, all, FRAGMENT, false, texture);
    assert_int_equal(batch.image_count, 0);
    assert_int_equal(batch.memory.dstStageMask, 0);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_image_destroy(gpu, &handle);
}

TEST_GPU(storage_images_keep_one_layout)
{
    gpu_image handle;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct image *image = new_image(gpu, &handle, 1, 4, GPU_SAMPLED | GPU_STORAGE);
    assert_int_equal(hazard_shader_layout(image), VK_IMAGE_LAYOUT_GENERAL);
    use_image(cmd, image, image_whole(image), COMPUTE, true, VK_IMAGE_LAYOUT_GENERAL);
    for (uint32_t mip = 1; mip < 4; mip++) { // a mip chain: barriers without transitions
        hazard_next_op(cmd);
        hazard_image(cmd, image, &(struct range){ mip, 1, 0, 1 },
                     &(struct access){ COMPUTE, true, VK_IMAGE_LAYOUT_GENERAL });
        hazard_image(cmd, image, &(struct range){ mip - 1, 1, 0, 1 },
                     &(struct access){ COMPUTE, false, VK_IMAGE_LAYOUT_GENERAL });
        assert_int_equal(cmd->batch.image_count, 0);
        assert_int_equal(cmd->batch.memory.srcAccessMask, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
        cmd->batch = (struct batch){ 0 };
    }
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_image_destroy(gpu, &handle);
}
