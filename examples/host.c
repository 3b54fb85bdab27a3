// A host with its own Vulkan device and G-buffer: renders 100 frames, two in flight, into its own
// command buffers. Between frames it moves a light and an object and changes options. Each frame's
// picture is copied to the host's own memory; the last one becomes a PNG.
//
//     host OUT.png [validate]
//
// `validate` turns the validation layer on; any message of it is a failure. Build it with an
// installed library:
//
//     cc host*.c $(pkg-config --cflags --libs afterglow vulkan) -lm -o host
#include "host_frame.h"
#include "host_surfaces.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 160, HEIGHT = 90, FRAMES = 100, IN_FLIGHT = 2 };

// A frame in flight, its G-buffer, and where the image goes.
struct slot {
    struct host_frame frame;
    struct host_gbuffer gbuffer;
    struct mapped_buffer picture; // RGBA, sRGB-encoded
    uint64_t number;              // of the frame that the GPU executes; 0: none
};

struct host {
    struct host_device vulkan;
    struct slot slots[IN_FLIGHT];
    // the library's
    struct ag_context *context;
    struct ag_device *lent;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct box boxes[BOXES];
};

static void check(const struct host *host, enum ag_result result)
{
    if (result == AG_OK) return;
    fprintf(stderr, "host: %s (%s)\n", ag_context_last_error(host->context),
            ag_result_string(result));
    exit(1);
}

// ---- frames in flight

// Those of struct ag_gbuffer.
static const VkFormat surface_formats[SURFACE_IMAGES] = {
    VK_FORMAT_D32_SFLOAT,    // SURFACE_DEPTH
    VK_FORMAT_R16G16_SFLOAT, // SURFACE_NORMAL
    VK_FORMAT_R8G8B8A8_SRGB, // SURFACE_ALBEDO
};

static void create_slots(struct host *host)
{
    for (int i = 0; i < IN_FLIGHT; i++) {
        struct slot *slot = &host->slots[i];
        host_frame_create(&host->vulkan, &slot->frame);
        mapped_buffer_create(&host->vulkan, 4 * WIDTH * HEIGHT, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                             &slot->picture);
        host_gbuffer_create(&host->vulkan, WIDTH, HEIGHT, surface_formats, &slot->gbuffer);
    }
}

static void destroy_slots(struct host *host)
{
    for (int i = 0; i < IN_FLIGHT; i++) {
        struct slot *slot = &host->slots[i];
        mapped_buffer_destroy(&host->vulkan, &slot->picture);
        host_gbuffer_destroy(&host->vulkan, &slot->gbuffer);
        host_frame_destroy(&host->vulkan, &slot->frame);
    }
}

// Waits for the frame that used the slot before and tells the library that it is done.
static void finish_slot(struct host *host, struct slot *slot)
{
    if (!slot->number) return;
    host_frame_wait(&host->vulkan, &slot->frame);
    check(host, ag_renderer_recorded_done(host->renderer, slot->number));
    slot->number = 0;
}

// ---- the library

enum { LIGHT = 0 }; // index in the scene

// The library knows the surfaces for their light, the host draws them.
static void create_scene(struct host *host)
{
    check(host, ag_scene_create(host->context, &host->scene));
    boxes_begin(host->boxes);
    check(host, boxes_add(host->boxes, host->scene));
    check(host, boxes_add_light(host->scene));
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

// Moves the light along half a circle and lifts a block.
static void move(struct host *host, int frame)
{
    const float turn = 3.14159265f * (float)frame / (float)FRAMES;
    struct ag_light_info info;
    check(host, ag_scene_get_light(host->scene, LIGHT, 0, 0.0, &info));
    info.light.position[0] += 0.01f * cosf(turn);
    info.light.position[2] += 0.01f * sinf(turn);
    check(host, ag_scene_set_light(host->scene, LIGHT, &info.light));
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

// An engine would light its own surfaces with "irradiance" here, or present "display". The layout
// that the copy needs is exchanged for the library's afterwards.
static void copy_picture(const struct host *host, const struct slot *slot)
{
    struct ag_layer_handle display;
    check(host, ag_renderer_layer_handle(host->renderer, "display", &display));
    const VkImage image = ag_vulkan_image(&display);
    const VkImageAspectFlags color = VK_IMAGE_ASPECT_COLOR_BIT;
    const VkBufferImageCopy region = host_whole_image(WIDTH, HEIGHT, color, 0);
    const VkImageLayout source = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    host_barrier(slot->frame.commands, image, color, ag_vulkan_layout(&display), source);
    vkCmdCopyImageToBuffer(slot->frame.commands, image, source, slot->picture.buffer, 1, &region);
    host_barrier(slot->frame.commands, image, color, source, ag_vulkan_layout(&display));
}

static void render(struct host *host, struct ag_frame_desc *frame, struct slot *slot)
{
    struct ag_gbuffer gbuffer;
    const VkCommandBuffer commands = slot->frame.commands;
    host_frame_begin(&slot->frame);
    boxes_draw(host->boxes, &frame->camera, &slot->gbuffer); // an engine would rasterise here
    host_gbuffer_upload(&slot->gbuffer, commands, &gbuffer);
    frame->gbuffer = &gbuffer; // needed only during the call
    check(host, ag_renderer_record(host->renderer, frame, commands, &slot->number));
    frame->gbuffer = NULL;
    copy_picture(host, slot);
    host_frame_submit(&host->vulkan, &slot->frame);
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
    host_device_create(&host.vulkan, argc == 3);
    create_slots(&host);
    if (ag_context_create(NULL, &host.context) != AG_OK) return 1;
    check(&host, host_device_lend(&host.vulkan, host.context, &host.lent));
    create_scene(&host);
    create_renderer(&host);
    render_all(&host);
    write_picture(&host, argv[1]);
    ag_renderer_destroy(host.renderer);
    ag_scene_destroy(host.scene);
    ag_device_destroy(host.lent);
    ag_context_destroy(host.context);
    destroy_slots(&host);
    host_device_destroy(&host.vulkan);
    return host.vulkan.messages ? 1 : 0;
}
