// Memory aliasing: the barrier with which one image takes over the memory of another, and the
// lifetime of that memory.
#include "framework/gpu_test.h"

#include "gpu/vk.h"

static const VkPipelineStageFlags2 COMPUTE = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
static const VkPipelineStageFlags2 FRAGMENT = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

static gpu_image make(struct gpu *gpu, const char *alias, uint32_t size)
{
    gpu_image image;
    const struct gpu_image_desc desc = { .name = "test.image",
                                         .format = GPU_RGBA16F,
                                         .width = size,
                                         .height = size,
                                         .usage = GPU_SAMPLED | GPU_STORAGE,
                                         .alias = alias };
    if (!gpu_image_create(gpu, &desc, &image)) fail_msg("no image: %s", test_last_message());
    hazard_overwrite_image(image_get(gpu, image));
    return image;
}

// The layout transitions that one access queues; records nothing.
static struct batch use(struct gpu_cmd *cmd, gpu_image handle, VkPipelineStageFlags2 stages,
                        bool write)
{
    struct image *image = image_get(cmd->gpu, handle);
    const struct range whole = image_whole(image);
    hazard_next_op(cmd);
    hazard_image(
        cmd, image, &whole,
        &(struct access){ .stages = stages, .write = write, .layout = VK_IMAGE_LAYOUT_GENERAL });
    const struct batch batch = cmd->batch;
    cmd->batch = (struct batch){ 0 };
    return batch;
}

static uint64_t client_bytes(const struct gpu *gpu, uint32_t client)
{
    struct gpu_memory owner = { 0 };
    gpu_client_memory(gpu, client, &owner, 1);
    return owner.bytes;
}

// One transition from UNDEFINED that waits for these stages and makes their writes available.
static void check_takes_over(const struct batch *batch, VkPipelineStageFlags2 waits_for)
{
    assert_int_equal(batch->image_count, 1);
    assert_int_equal(batch->images[0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
    assert_int_equal(batch->images[0].srcStageMask & waits_for, waits_for);
    assert_true(batch->images[0].srcAccessMask & VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    assert_int_equal(batch->images[0].dstStageMask, COMPUTE);
}

TEST_GPU(an_image_waits_for_all_accesses_of_the_one_whose_memory_it_takes_over)
{
    const uint32_t client = gpu_client_add(gpu);
    gpu_client_set(gpu, client);
    gpu_image a = make(gpu, "scratch", 64), b = make(gpu, "scratch", 48);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    use(cmd, a, COMPUTE, true);
    use(cmd, a, FRAGMENT, false);
    struct batch batch = use(cmd, b, COMPUTE, true);
    check_takes_over(&batch, COMPUTE | FRAGMENT);
    batch = use(cmd, b, COMPUTE, false); // it has the memory now
    assert_int_equal(batch.image_count, 0);
    batch = use(cmd, a, COMPUTE, true);
    check_takes_over(&batch, COMPUTE);
    assert_true(gpu_frame_end(gpu, cmd));
    assert_true(gpu_wait(gpu));
    // An image that is destroyed meanwhile.
    gpu_image_destroy(gpu, &a);
    assert_true(gpu_wait(gpu));
    cmd = gpu_frame_begin(gpu);
    batch = use(cmd, b, COMPUTE, true);
    check_takes_over(&batch, COMPUTE);
    assert_true(gpu_frame_end(gpu, cmd));
    gpu_image_destroy(gpu, &b);
    gpu_client_set(gpu, 0);
    gpu_client_remove(gpu, client);
}

static uint64_t bytes_alone(struct gpu *gpu, uint32_t client, uint32_t size)
{
    gpu_client_set(gpu, client);
    gpu_image image = make(gpu, "alone", size);
    const uint64_t bytes = client_bytes(gpu, client);
    gpu_image_destroy(gpu, &image);
    assert_true(gpu_wait(gpu));
    return bytes;
}

TEST_GPU(images_of_one_client_and_name_share_memory_that_is_large_enough)
{
    const uint32_t clients[2] = { gpu_client_add(gpu), gpu_client_add(gpu) };
    const uint64_t bytes_of_medium = bytes_alone(gpu, clients[1], 96);
    gpu_client_set(gpu, clients[0]);
    gpu_image first = make(gpu, "scratch", 64);
    const uint64_t bytes = client_bytes(gpu, clients[0]);
    gpu_image same = make(gpu, "scratch", 64), smaller = make(gpu, "scratch", 48);
    assert_int_equal(client_bytes(gpu, clients[0]), bytes);
    gpu_image larger = make(gpu, "scratch", 128), even = make(gpu, "scratch", 100);
    CHECK(client_bytes(gpu, clients[0]) >= bytes + 4 * bytes);
    CHECK(client_bytes(gpu, clients[0]) < bytes + 5 * bytes);
    gpu_image other = make(gpu, "other", 64);
    CHECK(client_bytes(gpu, clients[0]) >= 6 * bytes);
    gpu_client_set(gpu, clients[1]);
    gpu_image foreign = make(gpu, "scratch", 64);
    assert_int_equal(client_bytes(gpu, clients[1]), bytes);
    // The memory lasts as long as the last of its images.
    gpu_image *in_turn[] = { &first, &smaller, &larger, &even, &other, &foreign };
    for (int i = 0; i < 6; i++) gpu_image_destroy(gpu, in_turn[i]);
    assert_true(gpu_wait(gpu));
    assert_int_equal(client_bytes(gpu, clients[0]), bytes);
    assert_int_equal(client_bytes(gpu, clients[1]), 0);
    gpu_image_destroy(gpu, &same);
    assert_true(gpu_wait(gpu));
    assert_int_equal(client_bytes(gpu, clients[0]), 0);
    // A small image does not keep the memory of a large one, alive or destroyed.
    gpu_client_set(gpu, clients[0]);
    gpu_image large = make(gpu, "scratch", 128), small = make(gpu, "scratch", 64);
    gpu_image_destroy(gpu, &large);
    gpu_image medium = make(gpu, "scratch", 96);
    assert_true(gpu_wait(gpu));
    CHECK(client_bytes(gpu, clients[0]) <= bytes + bytes_of_medium);
    gpu_image_destroy(gpu, &small);
    gpu_image_destroy(gpu, &medium);
    assert_true(gpu_wait(gpu));
    assert_int_equal(client_bytes(gpu, clients[0]), 0);
    // The device itself, client 0, shares nothing.
    gpu_client_set(gpu, 0);
    gpu_image own[2] = { make(gpu, "scratch", 64), make(gpu, "scratch", 64) };
    CHECK(client_bytes(gpu, 0) >= 2 * bytes);
    for (int i = 0; i < 2; i++) gpu_image_destroy(gpu, &own[i]);
    for (int i = 0; i < 2; i++) gpu_client_remove(gpu, clients[i]);
}
