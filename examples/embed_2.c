// Steps 2 to 4 of docs/embed.md: a device lent to the library, a scene by calls, a first frame.
//
//     embed_2 OUT.png [validate]
#include "host_surfaces.h"

#include <afterglow/afterglow.h>

#include <stdio.h>

static enum ag_result build(struct ag_scene *scene)
{
    struct box boxes[BOXES];
    struct ag_light_desc light;
    ag_light_desc_default(&light, AG_LIGHT_POINT);
    light.position[1] = 1.6f;
    for (int i = 0; i < 3; i++) light.intensity[i] = 100; // candela
    boxes_begin(boxes);
    const enum ag_result result = boxes_add(boxes, scene);
    return result == AG_OK ? ag_scene_add_light(scene, &light, NULL) : result;
}

static enum ag_result render(struct ag_device *device, struct ag_scene *scene,
                             struct ag_image **picture)
{
    struct ag_renderer_desc desc;
    struct ag_frame_desc frame;
    struct ag_renderer *renderer = NULL;
    const float eye[3] = { 0, 1, 4 }, target[3] = { 0, 1, 0 };
    ag_renderer_desc_default(&desc);
    desc.width = 480;
    desc.height = 270;
    desc.gi = "lpv";
    ag_frame_desc_default(&frame);
    enum ag_result result = ag_scene_look_at(scene, eye, target, 0.7f, &frame.camera);
    if (result == AG_OK) result = ag_renderer_create(device, scene, &desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "display", picture);
    ag_renderer_destroy(renderer);
    return result;
}

static enum ag_result run(const struct host_device *host, struct ag_context *context,
                          const char *path)
{
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    struct ag_image *picture = NULL;
    enum ag_result result = host_device_lend(host, context, &device);
    if (result == AG_OK) result = ag_scene_create(context, &scene);
    if (result == AG_OK) result = build(scene);
    if (result == AG_OK) result = render(device, scene, &picture);
    if (result == AG_OK) result = ag_image_write_png(context, path, picture);
    ag_image_destroy(context, picture);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    return result;
}

int main(int argc, char **argv)
{
    struct host_device host;
    struct ag_context *context = NULL;
    if (argc < 2) return 2;
    host_device_create(&host, argc > 2); // with the validation layer
    enum ag_result result = ag_context_create(NULL, &context);
    if (result == AG_OK) result = run(&host, context, argv[1]);
    if (result != AG_OK) fprintf(stderr, "embed_2: %s\n", ag_context_last_error(context));
    ag_context_destroy(context);
    host_device_destroy(&host); // after all that uses the device
    return result == AG_OK && host.messages == 0 ? 0 : 1;
}
