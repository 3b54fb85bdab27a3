// Layers as Vulkan objects, used by a host's commands under validation.
#include "api/renderer_fixture.h"

#include <math.h>
#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT };

struct host_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *mapped;
};

static uint32_t mapped_type(const struct own_device *own, uint32_t bits)
{
    VkPhysicalDeviceMemoryProperties p;
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    vkGetPhysicalDeviceMemoryProperties(own->physical, &p);
    for (uint32_t i = 0; i < p.memoryTypeCount; i++)
        if (bits >> i & 1u && (p.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
    fail_msg("no mapped memory");
    return 0;
}

static struct host_buffer make_buffer(const struct own_device *own, size_t bytes)
{
    struct host_buffer out;
    VkMemoryRequirements needs;
    const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                      .size = bytes,
                                      .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT };
    assert_int_equal(vkCreateBuffer(own->device, &info, NULL, &out.buffer), VK_SUCCESS);
    vkGetBufferMemoryRequirements(own->device, out.buffer, &needs);
    const VkMemoryAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                            .allocationSize = needs.size,
                                            .memoryTypeIndex =
                                                mapped_type(own, needs.memoryTypeBits) };
    assert_int_equal(vkAllocateMemory(own->device, &allocate, NULL, &out.memory), VK_SUCCESS);
    assert_int_equal(vkBindBufferMemory(own->device, out.buffer, out.memory, 0), VK_SUCCESS);
    assert_int_equal(vkMapMemory(own->device, out.memory, 0, bytes, 0, &out.mapped), VK_SUCCESS);
    return out;
}

static void free_buffer(const struct own_device *own, struct host_buffer *buffer)
{
    vkDestroyBuffer(own->device, buffer->buffer, NULL);
    vkFreeMemory(own->device, buffer->memory, NULL);
}

static void transition(VkCommandBuffer commands, const struct ag_layer_handle *layer,
                       VkImageLayout from, VkImageLayout to)
{
    const VkImageAspectFlags aspect = layer->vk_format == VK_FORMAT_D32_SFLOAT
                                          ? VK_IMAGE_ASPECT_DEPTH_BIT
                                          : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageMemoryBarrier2 barrier = { .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                            .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                            .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
                                            .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                                            .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT,
                                            .oldLayout = from,
                                            .newLayout = to,
                                            .image = (VkImage)layer->vk_image,
                                            .subresourceRange = { aspect, 0, 1, 0, 1 } };
    const VkDependencyInfo info = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &barrier };
    vkCmdPipelineBarrier2(commands, &info);
}

// As the contract says: a barrier after the frame, and the layout restored.
static void copy_layer(VkCommandBuffer commands, const struct ag_layer_handle *layer,
                       const struct host_buffer *to)
{
    const VkImageLayout own = (VkImageLayout)layer->vk_layout;
    const VkBufferImageCopy region = { .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
                                       .imageExtent = { (uint32_t)layer->width,
                                                        (uint32_t)layer->height, 1 } };
    transition(commands, layer, own, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands, (VkImage)layer->vk_image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           to->buffer, 1, &region);
    transition(commands, layer, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, own);
}

static struct ag_layer_handle handle_of(struct renderer_fixture *s, const char *name)
{
    struct ag_layer_handle out;
    if (ag_renderer_layer_handle(s->renderer, name, &out) != AG_OK)
        fail_msg("%s: %s", name, ag_context_last_error(s->context));
    return out;
}

// All members but the scale.
static bool same_objects(const struct ag_layer_handle *a, const struct ag_layer_handle *b)
{
    return a->vk_image == b->vk_image && a->vk_image_view == b->vk_image_view &&
           a->vk_format == b->vk_format && a->vk_usage == b->vk_usage &&
           a->vk_layout == b->vk_layout && a->width == b->width && a->height == b->height;
}

static void record(struct renderer_fixture *s, struct own_device *own,
                   const struct ag_layer_handle *layer, const struct host_buffer *to)
{
    uint64_t frame;
    VkCommandBuffer commands = own_device_begin(own);
    assert_int_equal(ag_renderer_record(s->renderer, &s->frame, commands, &frame), AG_OK);
    copy_layer(commands, layer, to);
    own_device_run(own, commands);
    assert_int_equal(ag_renderer_recorded_done(s->renderer, frame), AG_OK);
}

static float half_to_float(uint16_t half)
{
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    const float value =
        exponent ? ldexpf((float)(1024 + mantissa), exponent - 25) : ldexpf((float)mantissa, -24);
    return half & 0x8000 ? -value : value;
}

TEST(handles_are_there_before_the_first_frame_and_stay_the_same)
{
    static const struct {
        const char *name;
        VkFormat format;
    } layers[] = { { "color", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "direct", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "indirect", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "irradiance", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "specular", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "visibility", VK_FORMAT_R8_UNORM },
                   { "albedo", VK_FORMAT_R8G8B8A8_SRGB },
                   { "normal", VK_FORMAT_R16G16_SFLOAT },
                   { "depth", VK_FORMAT_D32_SFLOAT },
                   { "emissive", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "motion", VK_FORMAT_R16G16B16A16_SFLOAT },
                   { "display", VK_FORMAT_R8G8B8A8_UNORM } };
    enum { COUNT = sizeof layers / sizeof layers[0] };
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    struct ag_layer_handle before[COUNT];
    for (int i = 0; i < COUNT; i++) {
        before[i] = handle_of(&s, layers[i].name);
        CHECK(before[i].vk_image && before[i].vk_image_view && before[i].scale == 1.0f);
        CHECK(before[i].width == FIXTURE_WIDTH && before[i].height == FIXTURE_HEIGHT);
        assert_int_equal(before[i].vk_format, layers[i].format);
        CHECK(before[i].vk_usage & VK_IMAGE_USAGE_SAMPLED_BIT);
        CHECK(before[i].vk_layout == VK_IMAGE_LAYOUT_GENERAL ||
              before[i].vk_layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    }
    static const char *const specs[] = { "lpv", "none", "lpv+vo",
                                         "vct:resolution=32,specular=true" };
    for (size_t k = 0; k < sizeof specs / sizeof *specs; k++) {
        assert_int_equal(ag_renderer_set_gi(s.renderer, specs[k], NULL, 0), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        for (int i = 0; i < COUNT; i++) {
            struct ag_image *image = fixture_read(&s, layers[i].name);
            ag_image_destroy(s.context, image);
            const struct ag_layer_handle now = handle_of(&s, layers[i].name);
            if (!same_objects(&now, &before[i])) fail_msg("%s changes", layers[i].name);
        }
    }
    struct ag_layer_handle handle;
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "position", &handle),
                     AG_ERROR_UNSUPPORTED);
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "debug", &handle), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "colour", &handle), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_resize(s.renderer, 20, 10), AG_OK);
    CHECK(handle_of(&s, "visibility").width == 20);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    fixture_close(&s);
    own_device_close(&own);
}

TEST(a_host_reads_the_newest_frame_in_its_own_commands)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    struct host_buffer buffer = make_buffer(&own, PIXELS * 8);
    const struct ag_layer_handle layer = handle_of(&s, "irradiance");
    for (int i = 0; i < 2; i++) record(&s, &own, &layer, &buffer);
    const float scale = handle_of(&s, "irradiance").scale;
    struct ag_finished_frame finished;
    assert_int_equal(ag_renderer_finished(s.renderer, &finished), AG_OK);
    CHECK(finished.frame == 2 && finished.scale == scale);
    struct ag_image *image = fixture_read(&s, "irradiance");
    const uint16_t *texels = buffer.mapped;
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 3; k++)
            CHECK(half_to_float(texels[4 * i + k]) / scale == image->pixels[3 * i + k]);
    ag_image_destroy(s.context, image);
    fixture_close(&s);
    free_buffer(&own, &buffer);
    own_device_close(&own);
}

TEST(ids_are_integers_one_above_those_that_are_read)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("none", &adopt);
    ag_renderer_destroy(s.renderer);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    desc.id_layer = true;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    struct host_buffer buffer = make_buffer(&own, PIXELS * 8);
    const struct ag_layer_handle layer = handle_of(&s, "id");
    assert_int_equal(layer.vk_format, VK_FORMAT_R32G32_UINT);
    CHECK(layer.scale == 1.0f);
    record(&s, &own, &layer, &buffer);
    struct ag_image *image = fixture_read(&s, "id");
    const uint32_t *texels = buffer.mapped;
    int most = 0;
    for (int i = 0; i < 2 * PIXELS; i++) {
        CHECK((float)texels[i] == image->pixels[i] + 1.0f);
        if ((int)texels[i] > most) most = (int)texels[i];
    }
    CHECK(most > 4);
    ag_image_destroy(s.context, image);
    fixture_close(&s);
    free_buffer(&own, &buffer);
    own_device_close(&own);
}

TEST(layers_that_no_technique_writes_are_neutral)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("none", &adopt);
    struct host_buffer buffer = make_buffer(&own, PIXELS * 8);
    static const char *const specs[] = { "none", "lpv+vo", "none" };
    for (int k = 0; k < 3; k++) {
        const bool neutral = strcmp(specs[k], "none") == 0;
        assert_int_equal(ag_renderer_set_gi(s.renderer, specs[k], NULL, 0), AG_OK);
        struct ag_layer_handle layer = handle_of(&s, "visibility");
        record(&s, &own, &layer, &buffer);
        const unsigned char *open = buffer.mapped;
        int ones = 0, zeros = 0;
        for (int i = 0; i < PIXELS; i++) ones += open[i] == 255;
        layer = handle_of(&s, "irradiance");
        record(&s, &own, &layer, &buffer);
        const uint16_t *light = buffer.mapped;
        for (int i = 0; i < PIXELS; i++) zeros += light[4 * i] == 0;
        CHECK((ones == PIXELS) == neutral && (zeros == PIXELS) == neutral);
    }
    fixture_close(&s);
    free_buffer(&own, &buffer);
    own_device_close(&own);
}
