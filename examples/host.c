// A host with its own Vulkan device and G-buffer: renders 100 frames, two in flight, into its own
// command buffers. Between frames it moves a light and an object and changes options. Each frame's
// picture is copied to the host's own memory; the last one becomes a PNG.
//
//     host OUT.png [validate]
//
// `validate` turns the validation layer on; any message of it is a failure. Build it with an
// installed library:
//
//     cc host.c host_surfaces.c $(pkg-config --cflags --libs afterglow vulkan) -lm -o host
#include "host_surfaces.h"

#include <afterglow/afterglow.h>
#include <afterglow/vulkan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 90, FRAMES = 100, IN_FLIGHT = 2 };

struct mapped_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *bytes;
};

// A frame in flight: commands, their fence, its G-buffer, and where the image goes.
struct slot {
    VkCommandBuffer commands;
    VkFence fence;
    struct mapped_buffer surfaces; // boxes_draw
    VkImage images[SURFACE_IMAGES];
    VkDeviceMemory image_memory[SURFACE_IMAGES];
    struct mapped_buffer picture; // RGBA, sRGB-encoded
    uint64_t number;              // of the frame that the GPU executes; 0: none
};

struct host {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    uint32_t family;
    struct ag_vulkan_requirements requirements;
    struct slot slots[IN_FLIGHT];
    int messages; // of the validation layer
    // the library's
    struct ag_context *context;
    struct ag_device *lent;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct box boxes[BOXES];
};

static void check_vk(VkResult result, const char *what)
{
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "host: %s: VkResult %d\n", what, (int)result);
    exit(1);
}

static void check(const struct host *host, enum ag_result result)
{
    if (result == AG_OK) return;
    fprintf(stderr, "host: %s (%s)\n", ag_context_last_error(host->context),
            ag_result_string(result));
    exit(1);
}

// ---- the host's own device

static VKAPI_ATTR VkBool32 VKAPI_CALL count_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    struct host *host = (struct host *)user;
    (void)severity;
    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE;
    fprintf(stderr, "host: %s\n", data->pMessage);
    host->messages++;
    return VK_FALSE;
}

static void create_instance(struct host *host, bool validate)
{
    const char *layers[] = { "VK_LAYER_KHRONOS_validation" };
    const char *extensions[] = { "VK_EXT_debug_utils", "VK_EXT_validation_features" };
    const VkValidationFeatureEnableEXT enable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger;
    memset(&messenger, 0, sizeof messenger);
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = count_message;
    messenger.pUserData = host;
    VkValidationFeaturesEXT features;
    memset(&features, 0, sizeof features);
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &messenger; // messages of vkCreateInstance and vkDestroyInstance
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &enable;
    VkApplicationInfo application;
    memset(&application, 0, sizeof application);
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validate) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    check_vk(vkCreateInstance(&info, NULL, &host->instance), "vkCreateInstance");
    if (!validate) return;
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(host->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    check_vk(create(host->instance, &messenger, NULL, &host->messenger), "messenger");
}

static void destroy_messenger(struct host *host)
{
    if (!host->messenger) return;
    const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            host->instance, "vkDestroyDebugUtilsMessengerEXT");
    destroy(host->instance, host->messenger, NULL);
}

// The first device, with a queue family that draws and computes. The library's requirements are
// the start of the host's own.
static void create_device(struct host *host)
{
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(host->instance, &count, &host->physical);
    check_vk(count == 1 ? VK_SUCCESS : VK_ERROR_INITIALIZATION_FAILED, "no Vulkan device");
    VkQueueFamilyProperties families[16];
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(host->physical, &count, families);
    while (host->family < count && (families[host->family].queueFlags & wanted) != wanted)
        host->family++;
    ag_vulkan_requirements_get(host->physical, &host->requirements);

    const float priority = 1;
    VkDeviceQueueCreateInfo queue;
    memset(&queue, 0, sizeof queue);
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = host->family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &host->requirements.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = host->requirements.extension_count;
    info.ppEnabledExtensionNames = host->requirements.extensions;
    check_vk(vkCreateDevice(host->physical, &info, NULL, &host->device), "vkCreateDevice");
    vkGetDeviceQueue(host->device, host->family, 0, &host->queue);
}

// ---- frames in flight

static void allocate_memory(const struct host *host, const VkMemoryRequirements *needs,
                            VkMemoryPropertyFlags wanted, VkDeviceMemory *out)
{
    VkPhysicalDeviceMemoryProperties p;
    vkGetPhysicalDeviceMemoryProperties(host->physical, &p);
    uint32_t i = 0;
    while (
        !((needs->memoryTypeBits >> i & 1u) && (p.memoryTypes[i].propertyFlags & wanted) == wanted))
        i++; // Vulkan guarantees that there is one
    VkMemoryAllocateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs->size;
    info.memoryTypeIndex = i;
    check_vk(vkAllocateMemory(host->device, &info, NULL, out), "vkAllocateMemory");
}

static void create_mapped_buffer(const struct host *host, VkDeviceSize bytes,
                                 VkBufferUsageFlags usage, struct mapped_buffer *out)
{
    VkBufferCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    check_vk(vkCreateBuffer(host->device, &info, NULL, &out->buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, out->buffer, &needs);
    allocate_memory(host, &needs,
                    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                    &out->memory);
    check_vk(vkBindBufferMemory(host->device, out->buffer, out->memory, 0), "vkBindBufferMemory");
    check_vk(vkMapMemory(host->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->bytes),
             "vkMapMemory");
}

// Those of struct ag_gbuffer.
static const VkFormat surface_formats[SURFACE_IMAGES] = {
    VK_FORMAT_D32_SFLOAT,    // SURFACE_DEPTH
    VK_FORMAT_R16G16_SFLOAT, // SURFACE_NORMAL
    VK_FORMAT_R8G8B8A8_SRGB, // SURFACE_ALBEDO
};
static const VkImageUsageFlags surface_usage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
static const VkImageLayout surface_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

static void create_surface_image(const struct host *host, VkFormat format, VkImage *image,
                                 VkDeviceMemory *memory)
{
    VkImageCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent.width = WIDTH;
    info.extent.height = HEIGHT;
    info.extent.depth = info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = surface_usage;
    check_vk(vkCreateImage(host->device, &info, NULL, image), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, *image, &needs);
    allocate_memory(host, &needs, 0, memory);
    check_vk(vkBindImageMemory(host->device, *image, *memory, 0), "vkBindImageMemory");
}

static void create_slots(struct host *host)
{
    VkCommandPoolCreateInfo pool;
    memset(&pool, 0, sizeof pool);
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = host->family;
    check_vk(vkCreateCommandPool(host->device, &pool, NULL, &host->pool), "vkCreateCommandPool");
    VkCommandBufferAllocateInfo allocate;
    memset(&allocate, 0, sizeof allocate);
    allocate.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate.commandPool = host->pool;
    allocate.commandBufferCount = 1;
    VkFenceCreateInfo fence;
    memset(&fence, 0, sizeof fence);
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    for (int i = 0; i < IN_FLIGHT; i++) {
        struct slot *slot = &host->slots[i];
        check_vk(vkAllocateCommandBuffers(host->device, &allocate, &slot->commands), "commands");
        check_vk(vkCreateFence(host->device, &fence, NULL, &slot->fence), "vkCreateFence");
        create_mapped_buffer(host, 4 * WIDTH * HEIGHT, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                             &slot->picture);
        create_mapped_buffer(host, SURFACE_IMAGES * 4 * WIDTH * HEIGHT,
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &slot->surfaces);
        for (int k = 0; k < SURFACE_IMAGES; k++)
            create_surface_image(host, surface_formats[k], &slot->images[k],
                                 &slot->image_memory[k]);
    }
}

static void destroy_slot(const struct host *host, const struct slot *slot)
{
    vkDestroyBuffer(host->device, slot->picture.buffer, NULL);
    vkFreeMemory(host->device, slot->picture.memory, NULL);
    vkDestroyBuffer(host->device, slot->surfaces.buffer, NULL);
    vkFreeMemory(host->device, slot->surfaces.memory, NULL);
    for (int k = 0; k < SURFACE_IMAGES; k++) {
        vkDestroyImage(host->device, slot->images[k], NULL);
        vkFreeMemory(host->device, slot->image_memory[k], NULL);
    }
    vkDestroyFence(host->device, slot->fence, NULL);
}

static void destroy_device(struct host *host)
{
    for (int i = 0; i < IN_FLIGHT; i++) destroy_slot(host, &host->slots[i]);
    vkDestroyCommandPool(host->device, host->pool, NULL);
    vkDestroyDevice(host->device, NULL);
    destroy_messenger(host);
    vkDestroyInstance(host->instance, NULL);
}

// Waits for the frame that used the slot before and tells the library that it is done.
static void finish_slot(struct host *host, struct slot *slot)
{
    if (!slot->number) return;
    check_vk(vkWaitForFences(host->device, 1, &slot->fence, VK_TRUE, UINT64_MAX), "frame");
    check_vk(vkResetFences(host->device, 1, &slot->fence), "vkResetFences");
    check(host, ag_renderer_recorded_done(host->renderer, slot->number));
    slot->number = 0;
}

// ---- the library

static void adopt_device(struct host *host)
{
    const struct ag_device_adopt adopt =
        ag_vulkan_adopt(host->instance, host->physical, host->device, host->queue, host->family,
                        &host->requirements);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = &adopt;
    if (ag_context_create(NULL, &host->context) != AG_OK) exit(1);
    check(host, ag_device_create(host->context, &desc, &host->lent));
}

enum { LAMP = 0 }; // index in the scene

// The library knows the surfaces for their light, the host draws them.
static void create_scene(struct host *host)
{
    struct ag_light_desc lamp;
    ag_light_desc_default(&lamp, AG_LIGHT_POINT);
    lamp.position[0] = -0.3f;
    lamp.position[1] = 1.6f;
    for (int i = 0; i < 3; i++) lamp.intensity[i] = 100; // candela
    check(host, ag_scene_create(host->context, &host->scene));
    boxes_begin(host->boxes);
    check(host, boxes_add(host->boxes, host->scene));
    check(host, ag_scene_add_light(host->scene, &lamp, NULL));
}

static void create_renderer(struct host *host)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = "lpv:dim=16";
    desc.host_gbuffer = true;
    check(host, ag_renderer_create(host->lent, host->scene, &desc, &host->renderer));
}

// Moves the lamp along half a circle and lifts a block.
static void move(struct host *host, int frame)
{
    const float turn = 3.14159265f * (float)frame / (float)FRAMES;
    struct ag_light_info lamp;
    check(host, ag_scene_get_light(host->scene, LAMP, 0, 0.0, &lamp));
    lamp.light.position[0] += 0.01f * cosf(turn);
    lamp.light.position[2] += 0.01f * sinf(turn);
    check(host, ag_scene_set_light(host->scene, LAMP, &lamp.light));
    host->boxes[BLOCK].center[1] += 0.006f * sinf(turn);
    check(host, box_move(&host->boxes[BLOCK], host->scene));
}

// A live option in each tenth frame, another technique and smaller shadow maps once. Frames in
// flight go on with what they were recorded with.
static void change_options(struct host *host, int frame)
{
    static const char *const steps[] = { "lpv:dim=16,steps=4", "lpv:dim=16,steps=12" };
    if (frame % 10 == 5)
        check(host, ag_renderer_set_gi(host->renderer, steps[frame / 10 % 2], NULL, 0));
    if (frame == 40) check(host, ag_renderer_set_gi(host->renderer, "ambient+vo", NULL, 0));
    if (frame == 60) check(host, ag_renderer_set_frame_options(host->renderer, "shadow_size=512"));
}

// ---- a frame

// Orders everything before it ahead of everything after it, and the host's reads.
static void barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                    VkImageLayout from, VkImageLayout to)
{
    VkMemoryBarrier2 memory;
    memset(&memory, 0, sizeof memory);
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_HOST_READ_BIT;
    VkImageMemoryBarrier2 layout;
    memset(&layout, 0, sizeof layout);
    layout.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    layout.srcStageMask = layout.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    layout.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    layout.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    layout.oldLayout = from;
    layout.newLayout = to;
    layout.srcQueueFamilyIndex = layout.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    layout.image = image;
    layout.subresourceRange.aspectMask = aspect;
    layout.subresourceRange.levelCount = layout.subresourceRange.layerCount = 1;
    VkDependencyInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &layout;
    vkCmdPipelineBarrier2(commands, &info);
}

static VkBufferImageCopy whole_image(VkImageAspectFlags aspect, VkDeviceSize offset)
{
    VkBufferImageCopy region;
    memset(&region, 0, sizeof region);
    region.bufferOffset = offset;
    region.imageSubresource.aspectMask = aspect;
    region.imageSubresource.layerCount = 1;
    region.imageExtent.width = WIDTH;
    region.imageExtent.height = HEIGHT;
    region.imageExtent.depth = 1;
    return region;
}

static void describe(const struct slot *slot, enum surface_image which, struct ag_layer_handle *out)
{
    out->vk_image = (void *)slot->images[which];
    out->vk_format = (uint32_t)surface_formats[which];
    out->vk_usage = surface_usage;
    out->vk_layout = (uint32_t)surface_layout;
    out->width = WIDTH;
    out->height = HEIGHT;
    out->scale = 1;
}

// An engine would rasterise here. The images of two frames alternate; their content is discarded.
static void draw_surfaces(const struct host *host, const struct ag_camera *camera,
                          const struct slot *slot, struct ag_gbuffer *out)
{
    boxes_draw(host->boxes, camera, WIDTH, HEIGHT, slot->surfaces.bytes);
    for (int k = 0; k < SURFACE_IMAGES; k++) {
        const VkImageAspectFlags aspect =
            k == SURFACE_DEPTH ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
        const VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkBufferImageCopy region = whole_image(aspect, (VkDeviceSize)k * 4 * WIDTH * HEIGHT);
        barrier(slot->commands, slot->images[k], aspect, VK_IMAGE_LAYOUT_UNDEFINED, target);
        vkCmdCopyBufferToImage(slot->commands, slot->surfaces.buffer, slot->images[k], target, 1,
                               &region);
        barrier(slot->commands, slot->images[k], aspect, target, surface_layout);
    }
    memset(out, 0, sizeof *out);
    describe(slot, SURFACE_DEPTH, &out->depth);
    describe(slot, SURFACE_NORMAL, &out->normal);
    describe(slot, SURFACE_ALBEDO, &out->albedo);
}

// An engine would light its own surfaces with "irradiance" here, or present "display". The layout
// that the copy needs is exchanged for the library's afterwards.
static void copy_picture(const struct host *host, const struct slot *slot)
{
    struct ag_layer_handle display;
    check(host, ag_renderer_layer_handle(host->renderer, "display", &display));
    const VkImage image = ag_vulkan_image(&display);
    const VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
    const VkBufferImageCopy region = whole_image(color, 0);
    const VkImageLayout source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier(slot->commands, image, color, ag_vulkan_layout(&display), source);
    vkCmdCopyImageToBuffer(slot->commands, image, source, slot->picture.buffer, 1, &region);
    barrier(slot->commands, image, color, source, ag_vulkan_layout(&display));
}

static void render(struct host *host, struct ag_frame_desc *frame, struct slot *slot)
{
    VkCommandBufferBeginInfo begin;
    memset(&begin, 0, sizeof begin);
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vk(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer");
    struct ag_gbuffer gbuffer;
    draw_surfaces(host, &frame->camera, slot, &gbuffer);
    frame->gbuffer = &gbuffer; // needed only during the call
    check(host, ag_renderer_record(host->renderer, frame, slot->commands, &slot->number));
    frame->gbuffer = NULL;
    copy_picture(host, slot);
    check_vk(vkEndCommandBuffer(slot->commands), "vkEndCommandBuffer");
    VkSubmitInfo submit;
    memset(&submit, 0, sizeof submit);
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot->commands;
    check_vk(vkQueueSubmit(host->queue, 1, &submit, slot->fence), "vkQueueSubmit");
}

static void render_all(struct host *host)
{
    struct ag_frame_desc frame;
    struct ag_layer_handle display;
    ag_frame_desc_default(&frame);
    const float eye[3] = { 0, 1, 4 }, target[3] = { 0, 1, 0 };
    check(host, ag_scene_look_at(host->scene, eye, target, 0.7f, &frame.camera));
    // The first call for a layer submits commands of its own: before the first frame.
    check(host, ag_renderer_layer_handle(host->renderer, "display", &display));
    for (int i = 0; i < FRAMES; i++) {
        struct slot *slot = &host->slots[i % IN_FLIGHT];
        finish_slot(host, slot);
        move(host, i);
        change_options(host, i);
        render(host, &frame, slot);
    }
    for (int i = 0; i < IN_FLIGHT; i++) finish_slot(host, &host->slots[(FRAMES + i) % IN_FLIGHT]);
    struct ag_finished_frame finished;
    check(host, ag_renderer_finished(host->renderer, &finished));
    printf("%d frames with %s, EV %.2f\n", (int)finished.frame, ag_renderer_gi(host->renderer),
           (double)finished.exposure_ev);
}

static float linear_from_srgb(unsigned char byte)
{
    const float v = (float)byte / 255.0f;
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

// The image of the last frame; images of the library are linear.
static void write_picture(const struct host *host, const char *path)
{
    const unsigned char *pixels =
        (const unsigned char *)host->slots[(FRAMES - 1) % IN_FLIGHT].picture.bytes;
    struct ag_image *image = NULL;
    check(host, ag_image_create(host->context, WIDTH, HEIGHT, 3, &image));
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        image->pixels[i] = linear_from_srgb(pixels[i / 3 * 4 + i % 3]);
    check(host, ag_image_write_png(host->context, path, image));
    ag_image_destroy(host->context, image);
}

int main(int argc, char **argv)
{
    if (argc < 2 || argc > 3 || (argc == 3 && strcmp(argv[2], "validate") != 0)) {
        fprintf(stderr, "usage: host OUT.png [validate]\n");
        return 2;
    }
    struct host host;
    memset(&host, 0, sizeof host);
    create_instance(&host, argc == 3);
    create_device(&host);
    create_slots(&host);
    adopt_device(&host);
    create_scene(&host);
    create_renderer(&host);
    render_all(&host);
    write_picture(&host, argv[1]);
    ag_renderer_destroy(host.renderer);
    ag_scene_destroy(host.scene);
    ag_device_destroy(host.lent);
    ag_context_destroy(host.context);
    destroy_device(&host);
    if (host.messages) fprintf(stderr, "host: %d messages of validation\n", host.messages);
    return host.messages ? 1 : 0;
}
