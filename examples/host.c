// A host with its own Vulkan device: renders 100 frames, two in flight, into its own command
// buffers. Between frames it moves a light and an object and changes options. Each frame's picture
// is copied to the host's own memory; the last one becomes a PNG.
//
//     host OUT.png [validate]
//
// `validate` turns the validation layer on; any message of it is a failure. Build it with an
// installed library:
//
//     cc host.c $(pkg-config --cflags --libs afterglow vulkan) -o host
#include <afterglow/afterglow.h>
#include <afterglow/vulkan.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 90, FRAMES = 100, IN_FLIGHT = 2 };

// A frame in flight: commands, their fence, and where the image goes.
struct slot {
    VkCommandBuffer commands;
    VkFence fence;
    VkBuffer buffer;
    VkDeviceMemory memory;
    unsigned char *pixels; // mapped: RGBA, sRGB-encoded
    uint64_t number;       // of the frame that the GPU executes; 0: none
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

static uint32_t mapped_memory_type(const struct host *host, uint32_t bits)
{
    VkPhysicalDeviceMemoryProperties p;
    const VkMemoryPropertyFlags wanted =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    vkGetPhysicalDeviceMemoryProperties(host->physical, &p);
    uint32_t i = 0;
    while (!((bits >> i & 1u) && (p.memoryTypes[i].propertyFlags & wanted) == wanted)) i++;
    return i; // Vulkan guarantees that there is one for buffers
}

static void create_picture(const struct host *host, struct slot *slot)
{
    VkBufferCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = 4 * WIDTH * HEIGHT;
    info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    check_vk(vkCreateBuffer(host->device, &info, NULL, &slot->buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, slot->buffer, &needs);
    VkMemoryAllocateInfo allocate;
    memset(&allocate, 0, sizeof allocate);
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = needs.size;
    allocate.memoryTypeIndex = mapped_memory_type(host, needs.memoryTypeBits);
    check_vk(vkAllocateMemory(host->device, &allocate, NULL, &slot->memory), "vkAllocateMemory");
    check_vk(vkBindBufferMemory(host->device, slot->buffer, slot->memory, 0), "vkBindBufferMemory");
    void *mapped = NULL;
    check_vk(vkMapMemory(host->device, slot->memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
    slot->pixels = (unsigned char *)mapped;
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
        create_picture(host, slot);
    }
}

static void destroy_device(struct host *host)
{
    for (int i = 0; i < IN_FLIGHT; i++) {
        vkDestroyBuffer(host->device, host->slots[i].buffer, NULL);
        vkFreeMemory(host->device, host->slots[i].memory, NULL);
        vkDestroyFence(host->device, host->slots[i].fence, NULL);
    }
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

static void create_renderer(struct host *host)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = "lpv:dim=16";
    check(host, ag_scene_load(host->context, "@cornell:light=point", &host->scene));
    check(host, ag_renderer_create(host->lent, host->scene, &desc, &host->renderer));
}

// Moves the lamp along half a circle and lifts the last instance, a block.
static void move(struct host *host, int frame)
{
    const float turn = 3.14159265f * (float)frame / (float)FRAMES;
    struct ag_light_info lamp;
    check(host, ag_scene_get_light(host->scene, LAMP, 0, 0.0, &lamp));
    lamp.light.position[0] += 0.02f * cosf(turn);
    lamp.light.position[2] += 0.02f * sinf(turn);
    check(host, ag_scene_set_light(host->scene, LAMP, &lamp.light));

    struct ag_scene_info info;
    struct ag_instance_info block;
    check(host, ag_scene_get_info(host->scene, 0, 0.0, &info));
    check(host, ag_scene_get_instance(host->scene, info.instances - 1, 0, 0.0, &block));
    block.world_from_mesh[13] += 0.01f * sinf(turn);
    check(host,
          ag_scene_set_instance_transform(host->scene, info.instances - 1, block.world_from_mesh));
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
static void barrier(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to)
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
    layout.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
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

// Where an engine would light its own surfaces with "irradiance", or present "display". The layout
// that the copy needs is exchanged for the library's afterwards.
static void copy_picture(const struct host *host, const struct slot *slot)
{
    struct ag_layer_handle display;
    check(host, ag_renderer_layer_handle(host->renderer, "display", &display));
    const VkImage image = ag_vulkan_image(&display);
    VkBufferImageCopy region;
    memset(&region, 0, sizeof region);
    region.imageSubresource.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    region.imageSubresource.layerCount = 1;
    region.imageExtent.width = WIDTH;
    region.imageExtent.height = HEIGHT;
    region.imageExtent.depth = 1;
    const VkImageLayout source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    barrier(slot->commands, image, ag_vulkan_layout(&display), source);
    vkCmdCopyImageToBuffer(slot->commands, image, source, slot->buffer, 1, &region);
    barrier(slot->commands, image, source, ag_vulkan_layout(&display));
}

static void render(struct host *host, const struct ag_frame_desc *frame, struct slot *slot)
{
    VkCommandBufferBeginInfo begin;
    memset(&begin, 0, sizeof begin);
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vk(vkBeginCommandBuffer(slot->commands, &begin), "vkBeginCommandBuffer");
    check(host, ag_renderer_record(host->renderer, frame, slot->commands, &slot->number));
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
    check(host, ag_scene_default_camera(host->scene, 0, 0.0, &frame.camera, NULL));
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
    const unsigned char *pixels = host->slots[(FRAMES - 1) % IN_FLIGHT].pixels;
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
