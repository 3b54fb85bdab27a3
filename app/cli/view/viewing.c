#include "viewing.h"

#include "cli/cache/cache.h"
#include "cli/cache/recent.h"
#include "cli/files/whole_file.h"
#include "cli/output.h"
#include "view_words.h"
#include "viewer/scene/session_file.h"
#include "viewer/viewer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GI_SIZE = 8192 };
_Static_assert((int)RECENT_SCENES <= (int)VIEWER_RECENT, "the viewer lists all");

struct views;

// A scene that is shown, with what belongs to it.
struct viewing {
    struct arguments arguments;
    struct views *views;
    char name[PATH_SIZE], gi[GI_SIZE]; // of a scene that was opened in the window
    char session_path[PATH_SIZE];
    struct session session;
    struct viewer_desc desc;
    struct view_words words;
    struct recent recent;
};

// The scene that is shown and, while another is opened, the one before.
struct views {
    struct viewing *all[2];
};

static bool write_image(void *user, struct ag_renderer *renderer, enum ag_tonemap curve,
                        const char *layer, const char *path)
{
    struct viewing *viewing = user;
    viewing->arguments.tonemap = curve;
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
    enum status status = session_begin(&copy, &viewing->arguments);
    if (status == DONE)
        status =
            session_load(&copy, viewing->arguments.positional[0], viewing->arguments.scene_scale);
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

static enum status check_methods(const struct arguments *a, struct ag_context *context)
{
    struct ag_renderer_desc desc;
    uint64_t bytes;
    enum ag_result result = AG_OK;
    ag_renderer_desc_default(&desc);
    desc.frame_options = arguments_frame_options(a);
    for (int i = 0; i < 2 && result == AG_OK; i++) {
        desc.gi = i == 0 ? a->gi : a->split;
        if (desc.gi && strcmp(desc.gi, "reference") != 0)
            result = ag_renderer_estimate_memory(context, &desc, 1, &bytes);
    }
    return result == AG_OK ? DONE : fail_library(context, result);
}

static enum status open_scene_of(struct viewing *viewing)
{
    const struct arguments *a = &viewing->arguments;
    struct session *session = &viewing->session;
    enum status status = session_load(session, a->positional[0], a->scene_scale);
    if (status == DONE) status = session_light(session);
    if (status == DONE) status = session_camera(session, a->time_s, &viewing->desc.camera);
    return status;
}

static void describe(struct viewing *viewing)
{
    const struct arguments *a = &viewing->arguments;
    struct viewer_desc *desc = &viewing->desc;
    const char *validation = getenv("AFTERGLOW_VALIDATION");
    view_words(&viewing->session, &desc->camera, &viewing->words);
    desc->context = viewing->session.context;
    desc->scene = viewing->session.scene;
    desc->scene_name = a->positional[0];
    desc->gi = a->gi;
    desc->frame_options = arguments_frame_options(a);
    desc->tonemap = a->tonemap;
    desc->metering = a->metering;
    desc->device = a->device;
    desc->scene_words = viewing->words.scene;
    desc->light_words = viewing->words.light;
    desc->kept_words = viewing->words.kept;
    desc->environment = viewing->words.environment;
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

static void list_recent(struct viewing *viewing, const char *path)
{
    struct viewer_desc *desc = &viewing->desc;
    recent_add(path);
    recent_read(&viewing->recent);
    desc->recent_count = viewing->recent.count;
    for (int i = 0; i < viewing->recent.count; i++) desc->recent[i] = viewing->recent.paths[i];
}

static void close_viewing(struct viewing *viewing)
{
    if (viewing) session_end(&viewing->session);
    free(viewing);
}

// A session file stands for its scene.
static enum status find_session(struct viewing *viewing)
{
    struct arguments *a = &viewing->arguments;
    if (!has_extension(a->positional[0], "json")) return DONE;
    snprintf(viewing->session_path, sizeof viewing->session_path, "%s", a->positional[0]);
    if (!session_file_scene(viewing->session_path, viewing->name, sizeof viewing->name))
        return fail("cannot view %s: it is no session file", viewing->session_path);
    a->session = viewing->session_path;
    a->positional[0] = viewing->name;
    return DONE;
}

// Options that describe the scene of the command line do not hold for another one.
static void forget_scene(struct arguments *a)
{
    a->camera = a->animation = a->environment = a->session = NULL;
    a->has_eye = a->has_target = a->has_fov = a->has_sky = a->no_scene_lights = a->has_exposure =
        false;
    a->has_scene_scale = false;
    a->light_count = 0;
    a->scene_scale = 1.0f;
    a->time_s = 0.0;
}

static const struct viewer_desc *open_scene(void *user, const char *path, const char *gi,
                                            char error[512])
{
    struct viewing *shown = user, *next = calloc(1, sizeof *next);
    struct views *views = shown->views;
    const int other = views->all[0] == shown;
    if (!next) {
        snprintf(error, 512, "cannot open %s: out of memory", path);
        return NULL;
    }
    close_viewing(views->all[other]);
    views->all[other] = next;
    next->views = views;
    next->arguments = shown->arguments;
    forget_scene(&next->arguments);
    snprintf(next->name, sizeof next->name, "%s", path);
    snprintf(next->gi, sizeof next->gi, "%s", gi);
    next->arguments.positional[0] = next->name;
    next->arguments.gi = next->gi;
    messages_keep(error, 512);
    enum status status = session_begin(&next->session, &next->arguments);
    if (status == DONE) status = find_session(next);
    if (status == DONE) status = open_scene_of(next);
    messages_keep(NULL, 0);
    if (status != DONE) return NULL;
    describe(next);
    next->desc.open_scene = shown->desc.open_scene;
    list_recent(next, path);
    return &next->desc;
}

static enum status view_in(struct views *views, const struct arguments *arguments)
{
    struct viewing *viewing = views->all[0] = calloc(1, sizeof *viewing);
    char error[1024];
    if (!viewing) return fail("cannot view %s: out of memory", arguments->positional[0]);
    viewing->views = views;
    viewing->arguments = *arguments;
    enum status status = session_begin(&viewing->session, &viewing->arguments);
    if (status == DONE) status = check_methods(&viewing->arguments, viewing->session.context);
    if (status == DONE) status = find_session(viewing);
    if (status == DONE) status = open_scene_of(viewing);
    if (status != DONE) return status;
    session_say(&viewing->session);
    describe(viewing);
    viewing->desc.open_scene = open_scene;
    list_recent(viewing, arguments->positional[0]);
    return viewer_run(&viewing->desc, error) ? DONE : fail("%s", error);
}

enum status viewing_run(const struct arguments *arguments)
{
    struct views *views = calloc(1, sizeof *views);
    if (!views) return fail("cannot view %s: out of memory", arguments->positional[0]);
    const enum status status = view_in(views, arguments);
    for (int i = 0; i < 2; i++) close_viewing(views->all[i]);
    free(views);
    return status;
}
