// Split screen: two cameras that share one light solution, in one PNG; the second one is nearer and
// to the side.
//
//     views SCENE GI WIDTH HEIGHT OUT.png
//
// WIDTH and HEIGHT are those of each half.
#include <afterglow/afterglow.h>

#include <stdio.h>
#include <stdlib.h>

enum { GAP_PX = 4, FRAMES = 4 };

struct game {
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    struct ag_renderer *renderer;
    struct ag_view *second;
    struct ag_frame_desc frame;
    struct ag_view_frame further;
};

static enum ag_result open_scene(struct game *game, const char *name)
{
    enum ag_result result = ag_context_create(NULL, &game->context);
    if (result == AG_OK) result = ag_device_create(game->context, NULL, &game->device);
    if (result == AG_OK) result = ag_scene_load(game->context, name, &game->scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(game->scene, NULL);
    return result;
}

static enum ag_result create_views(struct game *game, const char *gi, int width, int height)
{
    struct ag_renderer_desc first;
    struct ag_view_desc second;
    ag_renderer_desc_default(&first);
    ag_view_desc_default(&second);
    first.gi = gi;
    first.width = second.width = width;
    first.height = second.height = height;
    enum ag_result result = ag_renderer_create(game->device, game->scene, &first, &game->renderer);
    return result == AG_OK ? ag_view_create(game->renderer, &second, &game->second) : result;
}

// The renderer's own camera is the frame's; others are listed in `views`.
static enum ag_result place_cameras(struct game *game)
{
    ag_frame_desc_default(&game->frame);
    ag_view_frame_default(&game->further);
    game->further.view = game->second;
    game->frame.views = &game->further;
    game->frame.view_count = 1;
    struct ag_camera *here = &game->frame.camera;
    enum ag_result result = ag_scene_default_camera(game->scene, 0, 0.0, here, NULL);
    struct ag_scene_info scene;
    if (result == AG_OK) result = ag_scene_get_info(game->scene, 0, 0.0, &scene);
    if (result != AG_OK) return result;
    float centre[3], off[3]; // off: from the scene's centre to the first camera, shortened
    for (int i = 0; i < 3; i++) {
        centre[i] = 0.5f * (scene.bounds_min[i] + scene.bounds_max[i]);
        off[i] = 0.6f * (here->eye[i] - centre[i]);
    }
    const float c = 0.94f, s = 0.34f; // cosine and sine of 20 degrees about the vertical
    const float there[3] = { centre[0] + c * off[0] + s * off[2], centre[1] + off[1],
                             centre[2] - s * off[0] + c * off[2] };
    return ag_scene_look_at(game->scene, there, centre, here->vertical_fov_rad,
                            &game->further.camera);
}

static enum ag_result write_halves(struct game *game, const char *path)
{
    struct ag_image *halves[2] = { NULL, NULL }, *whole = NULL;
    enum ag_result result = ag_renderer_read(game->renderer, "display", &halves[0]);
    if (result == AG_OK) result = ag_view_read(game->second, "display", &halves[1]);
    if (result == AG_OK)
        result = ag_image_side_by_side(game->context, halves[0], halves[1], GAP_PX, &whole);
    if (result == AG_OK) result = ag_image_write_png(game->context, path, whole);
    ag_image_destroy(game->context, whole);
    ag_image_destroy(game->context, halves[0]);
    ag_image_destroy(game->context, halves[1]);
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 6) {
        fprintf(stderr, "usage: views SCENE GI WIDTH HEIGHT OUT.png\n");
        return 2;
    }
    struct game game = { NULL };
    enum ag_result result = open_scene(&game, argv[1]);
    if (result == AG_OK) result = create_views(&game, argv[2], atoi(argv[3]), atoi(argv[4]));
    if (result == AG_OK) result = place_cameras(&game);
    for (int i = 0; i < FRAMES && result == AG_OK; i++)
        result = ag_renderer_render(game.renderer, &game.frame);
    if (result == AG_OK) result = write_halves(&game, argv[5]);
    if (result != AG_OK) fprintf(stderr, "views: %s\n", ag_context_last_error(game.context));
    ag_view_destroy(game.second);
    ag_renderer_destroy(game.renderer);
    ag_scene_destroy(game.scene);
    ag_device_destroy(game.device);
    ag_context_destroy(game.context);
    return result == AG_OK ? 0 : 1;
}
