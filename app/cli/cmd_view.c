// afterglow view: the scene, light and camera of the command line in a window.
#include "cli/cache/cache.h"
#include "cli/files/whole_file.h"
#include "commands.h"
#include "output.h"
#include "view_words.h"
#include "viewer/viewer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct viewing {
    const struct arguments *arguments;
    struct session session;
    struct viewer_desc desc;
    struct view_words words;
};

static bool write_image(void *user, struct ag_renderer *renderer, const char *layer,
                        const char *path)
{
    struct viewing *viewing = user;
    struct output output = { .layers = { layer },
                             .layer_count = 1,
                             .exr = has_extension(path, "exr") };
    return output_try(&viewing->session, renderer, &output, path) == AG_OK;
}

static bool open_copy(void *user, struct ag_context **context, struct ag_scene **scene,
                      char error[512])
{
    const struct viewing *viewing = user;
    struct session copy;
    messages_keep(error, 512);
    enum status status = session_begin(&copy, viewing->arguments);
    if (status == DONE)
        status =
            session_load(&copy, viewing->arguments->positional[0], viewing->arguments->scene_scale);
    if (status == DONE) status = session_light(&copy);
    messages_keep(NULL, 0);
    *context = copy.context;
    *scene = copy.scene;
    ag_environment_destroy(copy.environment);
    return status == DONE;
}

static bool bake_path(void *user, const char *key, char path[4096], char error[512])
{
    char why[CACHE_WHY_SIZE];
    (void)user;
    if (cache_file(CACHE_BAKE, key, path, why)) return true;
    snprintf(error, 512, "cannot keep a bake: %.300s; " CACHE_REMEDY, why);
    return false;
}

static enum status put_text(FILE *file, const void *text)
{
    fputs(text, file);
    return DONE;
}

static bool write_text(void *user, const char *path, const char *text, char error[512])
{
    (void)user;
    messages_keep(error, 512);
    const bool done = whole_file_write(path, put_text, text) == DONE;
    messages_keep(NULL, 0);
    return done;
}

static enum status check_usage(const struct arguments *a, struct ag_context *context)
{
    struct ag_renderer_desc desc;
    uint64_t bytes;
    if (a->screenshot && !has_extension(a->screenshot, "png"))
        return wrong_usage("wrong value --screenshot %s: the file name must end in .png",
                           a->screenshot);
    if (a->screenshot && a->frames == 0 && !a->script)
        return wrong_usage("cannot use --screenshot: it requires --frames or --script");
    ag_renderer_desc_default(&desc);
    desc.frame_options = a->frame_options;
    enum ag_result result = AG_OK;
    for (int i = 0; i < 2 && result == AG_OK; i++) {
        desc.gi = i == 0 ? a->gi : a->split;
        if (desc.gi && strcmp(desc.gi, "reference") != 0)
            result = ag_renderer_estimate_memory(context, &desc, 1, &bytes);
    }
    return result == AG_OK ? DONE : fail_library(context, result);
}

static enum status open_scene(struct viewing *viewing)
{
    const struct arguments *a = viewing->arguments;
    struct session *session = &viewing->session;
    enum status status = session_load(session, a->positional[0], a->scene_scale);
    if (status == DONE) status = session_light(session);
    if (status == DONE) status = session_camera(session, a->time_s, &viewing->desc.camera);
    return status;
}

static void describe(struct viewing *viewing)
{
    const struct arguments *a = viewing->arguments;
    struct viewer_desc *desc = &viewing->desc;
    const char *validation = getenv("AFTERGLOW_VALIDATION");
    view_words(&viewing->session, &desc->camera, &viewing->words);
    desc->context = viewing->session.context;
    desc->scene = viewing->session.scene;
    desc->scene_name = a->positional[0];
    desc->gi = a->gi;
    desc->frame_options = a->frame_options;
    desc->device = a->device;
    desc->scene_words = viewing->words.scene;
    desc->light_words = viewing->words.light;
    desc->kept_words = viewing->words.kept;
    desc->camera_words = viewing->words.camera;
    desc->animation = viewing->session.animation;
    desc->time_s = a->time_s;
    desc->has_exposure = a->has_exposure;
    desc->exposure_ev = a->exposure_ev;
    desc->width = a->width;
    desc->height = a->height;
    desc->scale = a->scale;
    desc->split = a->split;
    desc->session = a->session;
    desc->script = a->script;
    desc->screenshot = a->screenshot;
    desc->frames = a->frames;
    desc->validate = validation && strcmp(validation, "1") == 0;
    desc->user = viewing;
    desc->write = write_image;
    desc->open_copy = open_copy;
    desc->bake_path = bake_path;
    desc->write_text = write_text;
}

static enum status view(const struct arguments *arguments)
{
    struct viewing *viewing = calloc(1, sizeof *viewing);
    char error[1024];
    if (!viewing) return fail("cannot view %s: out of memory", arguments->positional[0]);
    viewing->arguments = arguments;
    enum status status = session_begin(&viewing->session, arguments);
    if (status == DONE) status = check_usage(arguments, viewing->session.context);
    if (status == DONE) status = open_scene(viewing);
    if (status == DONE) session_say(&viewing->session);
    if (status == DONE) {
        describe(viewing);
        if (!viewer_run(&viewing->desc, error)) status = fail("%s", error);
    }
    session_end(&viewing->session);
    free(viewing);
    return status;
}

const struct command command_view = {
    .name = "view",
    .bit = VIEW,
    .positional_count = 1,
    .usage = "SCENE [options]",
    .summary = "look at SCENE in a window, light it, compare methods and see what they cost",
    .text =
        "Opens a window with SCENE. W A S D, Q and E fly, the right mouse button looks around,\n"
        "the middle one turns around what is in front, the wheel goes nearer, F looks at what\n"
        "was clicked. The panels at the side have lights, methods with all their options,\n"
        "times and memory; 'Copy as command' gives the command line for the same image.\n",
    .examples = "  afterglow view @atrium --gi lpv\n"
                "      a built-in scene with light propagation volumes\n"
                "  afterglow view house.glb --gi vct+vo --split none\n"
                "      two methods in one image\n"
                "  afterglow view @cornell --frames 10 --screenshot window.png\n"
                "      ten frames, then the window as an image; also on a virtual display\n",
    .run = view,
};
