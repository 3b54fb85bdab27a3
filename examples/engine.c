// An engine that lends its device to the library: a G-buffer in formats of its own, a camera by
// matrices with jitter, and a switch between techniques while frames go on.
//
//     engine REVERSED.png FORWARD.png [validate]
//
// Two layouts of engine_surfaces.c are rendered one after the other, each into a PNG. A second
// renderer with the library's own G-buffer renders the same frames; the images may differ by no
// more than the formats round. `validate` turns the validation layer on, with synchronization
// validation; any message of it is a failure. With an installed library:
//
//     cc engine*.c host_*.c $(pkg-config --cflags --libs afterglow vulkan) -lm -pthread -o engine
#include "engine_surfaces.h"
#include "engine_switch.h"
#include "host_frame.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { WIDTH = 160, HEIGHT = 90, IN_FLIGHT = 2, FIRST = 12, LATER = 24 };

static const char gi_before[] = "lpv:dim=16";
// The first layout has no motion: its techniques must do without a history.
static const char *const gi_after[ENGINE_LAYOUTS] = { "vct:resolution=32,temporal=false+vo",
                                                      "vct:resolution=32+vo:temporal=true" };

// A frame in flight, with its numbers for the two renderers; 0: none.
struct slot {
    struct host_frame frame;
    struct host_gbuffer gbuffer;
    uint64_t hosted, own;
};

struct engine {
    struct host_device vulkan;
    struct ag_context *context;
    struct ag_device *lent;
    struct ag_scene *scene;
    // of a layout
    const struct engine_layout *layout;
    struct slot slots[IN_FLIGHT];
    struct ag_renderer *hosted, *own; // with the engine's G-buffer, with the library's
    struct engine_frame frame;
    int frames; // rendered
};

static void check(const struct engine *engine, enum ag_result result)
{
    if (result == AG_OK) return;
    fprintf(stderr, "engine: %s (%s)\n", ag_context_last_error(engine->context),
            ag_result_string(result));
    exit(1);
}

static double now_ms(void)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

// ---- beginning and end

static void create_scene(struct engine *engine)
{
    check(engine, ag_scene_create(engine->context, &engine->scene));
    boxes_begin(engine->frame.boxes);
    check(engine, boxes_add(engine->frame.boxes, engine->scene));
    check(engine, boxes_add_light(engine->scene));
}

static void create_renderers(struct engine *engine, const char *gi)
{
    struct ag_renderer_desc desc;
    struct ag_gbuffer_layout layout;
    ag_renderer_desc_default(&desc);
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.gi = gi;
    check(engine, ag_renderer_create(engine->lent, engine->scene, &desc, &engine->own));
    engine_layout_describe(engine->layout, WIDTH, HEIGHT, &layout);
    desc.host_gbuffer = true;
    desc.gbuffer_layout = &layout;
    check(engine, ag_renderer_create(engine->lent, engine->scene, &desc, &engine->hosted));
}

static void begin(struct engine *engine, int which)
{
    engine->layout = &engine_layouts[which];
    engine->frames = 0;
    for (int i = 0; i < IN_FLIGHT; i++) {
        struct slot *slot = &engine->slots[i];
        host_frame_create(&engine->vulkan, &slot->frame);
        host_gbuffer_create(&engine->vulkan, WIDTH, HEIGHT, engine->layout->formats,
                            &slot->gbuffer);
    }
    create_renderers(engine, gi_before);
}

// Waits for the frame that used the slot before and tells both renderers that it is done.
static void finish_slot(struct engine *engine, struct slot *slot)
{
    if (!slot->hosted) return;
    host_frame_wait(&engine->vulkan, &slot->frame);
    check(engine, ag_renderer_recorded_done(engine->hosted, slot->hosted));
    check(engine, ag_renderer_recorded_done(engine->own, slot->own));
    slot->hosted = 0;
}

static void finish(struct engine *engine)
{
    for (int i = 0; i < IN_FLIGHT; i++)
        finish_slot(engine, &engine->slots[(engine->frames + i) % IN_FLIGHT]);
}

static void end(struct engine *engine)
{
    ag_renderer_destroy(engine->hosted);
    ag_renderer_destroy(engine->own);
    for (int i = 0; i < IN_FLIGHT; i++) {
        host_gbuffer_destroy(&engine->vulkan, &engine->slots[i].gbuffer);
        host_frame_destroy(&engine->vulkan, &engine->slots[i].frame);
    }
}

// ---- a frame

// A block goes up and down, the camera to the right.
static void move(struct engine *engine)
{
    struct engine_frame *frame = &engine->frame;
    struct box *block = &frame->boxes[BLOCK];
    memcpy(frame->last_boxes, frame->boxes, sizeof frame->boxes);
    frame->last_camera = frame->camera;
    block->center[1] = 0.6f + 0.2f * sinf(0.2f * (float)engine->frames);
    check(engine, box_move(block, engine->scene));
    engine_camera_set(engine->frames, engine->layout->depth, WIDTH, HEIGHT, &frame->camera);
    if (engine->frames > 1) return;
    memcpy(frame->last_boxes, frame->boxes, sizeof frame->boxes);
    frame->last_camera = frame->camera;
}

static void describe_frame(const struct engine *engine, struct ag_frame_desc *out)
{
    ag_frame_desc_default(out);
    out->auto_exposure = false;
    out->exposure_ev = 4.6f;
    out->matrices = &engine->frame.camera.matrices;
}

static void upload(const struct engine *engine, const struct slot *slot, struct ag_gbuffer *out)
{
    const struct engine_camera *camera = &engine->frame.camera, *last = &engine->frame.last_camera;
    engine_draw(&engine->frame, engine->layout, &slot->gbuffer);
    host_gbuffer_upload(&slot->gbuffer, slot->frame.commands, out);
    out->motion_offset[0] = (camera->jitter[0] - last->jitter[0]) / (float)WIDTH;
    out->motion_offset[1] = (camera->jitter[1] - last->jitter[1]) / (float)HEIGHT;
}

// Milliseconds of the calls that an engine makes in a frame; the first one with another GI spec if
// `gi` names one.
static double render(struct engine *engine, const char *gi)
{
    struct slot *slot = &engine->slots[engine->frames++ % IN_FLIGHT];
    const VkCommandBuffer commands = slot->frame.commands;
    struct ag_frame_desc frame;
    struct ag_gbuffer gbuffer;
    finish_slot(engine, slot);
    move(engine);
    describe_frame(engine, &frame);
    host_frame_begin(&slot->frame);
    upload(engine, slot, &gbuffer);
    frame.gbuffer = &gbuffer;
    const double start = now_ms();
    if (gi) check(engine, ag_renderer_set_gi(engine->hosted, gi, NULL, 0));
    check(engine, ag_renderer_record(engine->hosted, &frame, commands, &slot->hosted));
    const double ms = now_ms() - start;
    frame.gbuffer = NULL;
    if (gi) check(engine, ag_renderer_set_gi(engine->own, gi, NULL, 0));
    check(engine, ag_renderer_record(engine->own, &frame, commands, &slot->own));
    host_frame_submit(&engine->vulkan, &slot->frame);
    return ms;
}

// ---- frames before, at and after the switch

static double longest_of(struct engine *engine, int frames)
{
    double longest = 0;
    for (int i = 0; i < frames; i++) longest = fmax(longest, render(engine, NULL));
    return longest;
}

static void render_all(struct engine *engine, const char *gi)
{
    struct engine_switch change;
    render(engine, NULL); // the first frame creates what the renderer lacks
    const double before = longest_of(engine, FIRST);
    double meanwhile = 0;
    int frames = 0;
    check(engine, engine_switch_begin(&change, engine->hosted, gi));
    for (; !engine_switch_ready(&change); frames++)
        meanwhile = fmax(meanwhile, render(engine, NULL));
    check(engine, engine_switch_end(&change));
    const double at = render(engine, gi);
    const double after = longest_of(engine, LATER);
    finish(engine);
    printf("%s: longest frame call: %.2f ms before, %.2f ms in %d frames beside the preparation, "
           "%.2f ms at the switch, %.2f ms after it\n",
           engine->layout->name, before, meanwhile, frames, at, after);
}

// ---- images

static struct ag_image *read_layer(const struct engine *engine, struct ag_renderer *renderer,
                                   const char *layer)
{
    struct ag_image *image = NULL;
    check(engine, ag_renderer_read(renderer, layer, &image));
    return image;
}

// Bounds of the mean relative difference of the radiance. First: normals along axes and albedo are
// exact; what remains are pixels on edges, which may see the other surface. Second: an albedo of 8
// linear bits rounds by up to 1/510, of 0.7 and 0.06 by 0.1 and 1 % in the mean; normals of 10 bits
// turn by up to 1/700.
static const double bounds[ENGINE_LAYOUTS] = { 1e-3, 5e-3 };

static bool compare(const struct engine *engine, double bound)
{
    struct ag_image *image = read_layer(engine, engine->hosted, "color");
    struct ag_image *expected = read_layer(engine, engine->own, "color");
    double difference = 0, mean = 0;
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++) {
        difference += fabs((double)image->pixels[i] - (double)expected->pixels[i]);
        mean += (double)expected->pixels[i];
    }
    ag_image_destroy(engine->context, image);
    ag_image_destroy(engine->context, expected);
    printf("%s: differs from the library's own by %.3g, bound %g\n", engine->layout->name,
           difference / mean, bound);
    return difference <= bound * mean && mean > 0;
}

static void write_picture(const struct engine *engine, const char *path)
{
    struct ag_image *image = read_layer(engine, engine->hosted, "display");
    check(engine, ag_image_write_png(engine->context, path, image));
    ag_image_destroy(engine->context, image);
}

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 4 || (argc == 4 && strcmp(argv[3], "validate") != 0)) {
        fprintf(stderr, "usage: engine REVERSED.png FORWARD.png [validate]\n");
        return 2;
    }
    struct engine engine;
    bool equal = true;
    memset(&engine, 0, sizeof engine);
    host_device_create(&engine.vulkan, argc == 4);
    if (ag_context_create(NULL, &engine.context) != AG_OK) return 1;
    check(&engine, host_device_lend(&engine.vulkan, engine.context, &engine.lent));
    create_scene(&engine);
    for (int i = 0; i < ENGINE_LAYOUTS; i++) {
        begin(&engine, i);
        render_all(&engine, gi_after[i]);
        equal = compare(&engine, bounds[i]) && equal;
        write_picture(&engine, argv[1 + i]);
        end(&engine);
    }
    ag_scene_destroy(engine.scene);
    ag_device_destroy(engine.lent);
    ag_context_destroy(engine.context);
    host_device_destroy(&engine.vulkan);
    return engine.vulkan.messages || !equal ? 1 : 0;
}
