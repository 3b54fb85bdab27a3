// Renders one scene with two GI specs at the exposure of the right one and writes both into one
// PNG.
//
//     side_by_side SCENE GI_LEFT GI_RIGHT WIDTH HEIGHT OUT.png
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <stdlib.h>

enum { GAP_PX = 4, FRAMES = 16 }; // frames: until temporal accumulation has converged

struct shot {
    const char *gi;
    int width, height;
    struct ag_frame_desc frame;
};

static void log_to_stderr(void *user, enum ag_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "side_by_side: %s%s\n", level == AG_LOG_ERROR ? "" : "note: ", message);
}

// Renders radiance with shot->gi.
static enum ag_result take(struct ag_device *device, struct ag_scene *scene,
                           const struct shot *shot, struct ag_image **out)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = shot->width;
    desc.height = shot->height;
    desc.gi = shot->gi;
    struct ag_renderer *renderer = NULL;
    enum ag_result result = ag_renderer_create(device, scene, &desc, &renderer);
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(renderer, &shot->frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", out);
    ag_renderer_destroy(renderer);
    return result;
}

// Tone maps both with one exposure and places them side by side.
static enum ag_result write_pair(struct ag_context *context, struct ag_image *const radiance[2],
                                 const char *path)
{
    const float ev = ag_image_auto_exposure(radiance[1]);
    struct ag_image *display[2] = { NULL, NULL }, *pair = NULL;
    enum ag_result result = AG_OK;
    for (int i = 0; i < 2 && result == AG_OK; i++)
        result = ag_image_tonemap(context, radiance[i], ev, &display[i]);
    if (result == AG_OK)
        result = ag_image_side_by_side(context, display[0], display[1], GAP_PX, &pair);
    if (result == AG_OK) result = ag_image_write_png(context, path, pair);
    ag_image_destroy(context, pair);
    ag_image_destroy(context, display[0]);
    ag_image_destroy(context, display[1]);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 7) {
        fprintf(stderr, "usage: side_by_side SCENE GI_LEFT GI_RIGHT WIDTH HEIGHT OUT.png\n");
        return 2;
    }
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.log = log_to_stderr;
    struct ag_context *context = NULL;
    struct ag_device *device = NULL;
    struct ag_scene *scene = NULL;
    struct ag_image *radiance[2] = { NULL, NULL };
    struct shot shot = { .width = atoi(argv[4]), .height = atoi(argv[5]) };
    ag_frame_desc_default(&shot.frame);

    enum ag_result result = ag_context_create(&desc, &context);
    if (result == AG_OK) result = ag_device_create(context, NULL, &device);
    if (result == AG_OK) result = ag_scene_load(context, argv[1], &scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(scene, NULL);
    if (result == AG_OK) result = ag_scene_default_camera(scene, 0, 0.0, &shot.frame.camera, NULL);
    for (int i = 0; i < 2 && result == AG_OK; i++) {
        shot.gi = argv[2 + i];
        result = take(device, scene, &shot, &radiance[i]);
    }
    if (result == AG_OK) result = write_pair(context, radiance, argv[6]);

    ag_image_destroy(context, radiance[0]);
    ag_image_destroy(context, radiance[1]);
    ag_scene_destroy(scene);
    ag_device_destroy(device);
    ag_context_destroy(context);
    return result == AG_OK ? 0 : 1;
}
