// Step 5 of docs/embed.md: a frame of the library within a frame of the program. The program's
// frame is a linear image of its own; the library's picture is a part of it.
//
//     embed_3 OUT.png [validate]
#include "host_frame.h"
#include "host_surfaces.h"

#include <afterglow/afterglow.h>

#include <stdio.h>
#include <stdlib.h>

enum {
    WIDTH = 480,
    HEIGHT = 270,
    BORDER = 30,
    ROW = WIDTH + 2 * BORDER,
    ROWS = HEIGHT + 2 * BORDER
};

static void check(const struct ag_context *context, enum ag_result result)
{
    if (result == AG_OK) return;
    fprintf(stderr, "embed_3: %s\n", ag_context_last_error(context));
    exit(1);
}

// The library's picture goes into the middle of the program's frame. A layout that the copy needs
// is exchanged for the library's afterwards.
static void composite(VkCommandBuffer commands, const struct ag_layer_handle *layer, VkBuffer frame)
{
    const VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageLayout own = ag_vulkan_layout(layer),
                        source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkDeviceSize corner = 4 * (BORDER * ROW + BORDER);
    VkBufferImageCopy region = host_whole_image(layer->width, layer->height, color, corner);
    region.bufferRowLength = ROW;
    host_barrier(commands, ag_vulkan_image(layer), color, own, source);
    vkCmdCopyImageToBuffer(commands, ag_vulkan_image(layer), source, frame, 1, &region);
    host_barrier(commands, ag_vulkan_image(layer), color, source, own);
}

// One command buffer with the program's own commands before and after the library's.
static void render(const struct host_device *host, struct ag_context *context,
                   struct ag_renderer *renderer, struct ag_scene *scene, VkBuffer picture)
{
    struct host_frame slot;
    struct ag_frame_desc frame;
    struct ag_layer_handle display;
    uint64_t number = 0;
    ag_frame_desc_default(&frame);
    check(context, ag_scene_default_camera(scene, 0, 0, &frame.camera, NULL));
    // The first call for a layer submits commands of its own: before the first frame.
    check(context, ag_renderer_layer_handle(renderer, "display", &display));
    host_frame_create(host, &slot);
    host_frame_begin(&slot);
    vkCmdFillBuffer(slot.commands, picture, 0, VK_WHOLE_SIZE, 0xff808080u); // the program's own
    check(context, ag_renderer_record(renderer, &frame, slot.commands, &number));
    composite(slot.commands, &display, picture);
    host_frame_submit(host, &slot);
    host_frame_wait(host, &slot);
    check(context, ag_renderer_recorded_done(renderer, number));
    host_frame_destroy(host, &slot);
}

static void write_picture(struct ag_context *context, const unsigned char *bytes, const char *path)
{
    struct ag_image *encoded = NULL;
    check(context, ag_image_create(context, ROW, ROWS, 3, &encoded));
    for (int i = 0; i < 3 * ROW * ROWS; i++)
        encoded->pixels[i] = linear_from_srgb(bytes[i / 3 * 4 + i % 3]);
    check(context, ag_image_write_png(context, path, encoded));
    ag_image_destroy(context, encoded);
}

static void run(const struct host_device *host, struct ag_context *context, const char *path)
{
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc;
    struct mapped_buffer picture;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = "lpv+vo";
    mapped_buffer_create(host, 4 * ROW * ROWS, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &picture);
    check(context, host_device_lend(host, context, &device));
    check(context, ag_scene_load(context, "@cornell:light=point", &scene));
    check(context, ag_renderer_create(device, scene, &desc, &renderer));
    render(host, context, renderer, scene, picture.buffer);
    write_picture(context, (const unsigned char *)picture.bytes, path);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    mapped_buffer_destroy(host, &picture);
}

int main(int argc, char **argv)
{
    struct host_device host;
    struct ag_context *context = NULL;
    if (argc < 2) return 2;
    host_device_create(&host, argc > 2); // with the validation layer
    if (ag_context_create(NULL, &context) != AG_OK) return 1;
    run(&host, context, argv[1]);
    ag_context_destroy(context);
    host_device_destroy(&host);
    return host.messages == 0 ? 0 : 1;
}
