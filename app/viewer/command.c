// The command line that renders what is shown, and its image as a file.
#include "command.h"

#include "operations.h"
#include "shell/words.h"
#include "viewer/methods/tone.h"

#include <stdio.h>
#include <string.h>

static void add_camera(struct words *w, const struct viewer *v)
{
    float target[3];
    if (!v->look.moved) {
        const char *name = ag_scene_camera_name(v->desc->scene, v->scene_camera);
        if (v->scene_camera >= 0) {
            words_add(w, " --camera");
            words_add_word(w, name);
        } else {
            words_add(w, "%s", v->desc->camera_words);
        }
        return;
    }
    look_target(&v->look, target);
    words_add(w, " --eye ");
    words_add_triple(w, v->look.eye);
    words_add(w, " --target ");
    words_add_triple(w, target);
    words_add(w, " --fov %.9g", (double)v->look.fov_deg);
}

static void add_light(struct words *w, const struct ag_light_desc *light)
{
    if (!light->enabled) return;
    if (light->type == AG_LIGHT_SUN) {
        words_add(w, " --light sun:");
        words_add_triple(w, light->direction);
    } else {
        words_add(w, " --light %s:", light->type == AG_LIGHT_POINT ? "point" : "spot");
        words_add_triple(w, light->position);
    }
    if (light->type == AG_LIGHT_SPOT) {
        words_add(w, ":");
        words_add_triple(w, light->direction);
        words_add(w, ":%.9g:%.9g", (double)light->inner_rad * 57.29577951308232,
                  (double)light->outer_rad * 57.29577951308232);
    }
    words_add(w, ":");
    words_add_triple(w, light->intensity);
}

// That of the command line is left out, or said again; NULL: there is no option for the present
// one.
static const char *environment_text(const struct viewer *v)
{
    const struct environment_choice *choice = &v->edits.environment;
    const bool own = v->edits.first_environment.source == ENVIRONMENT_OF_SCENE;
    const char *given = v->desc->environment;
    if (choice->source == ENVIRONMENT_FILE) return choice->path;
    if (choice->source == ENVIRONMENT_OF_SCENE) return given[0] ? given : NULL;
    return own && !given[0] ? NULL : "";
}

static void add_environment(struct words *w, const struct viewer *v)
{
    const struct environment_choice *choice = &v->edits.environment;
    const char *text = environment_text(v);
    char value[ENVIRONMENT_PATH_SIZE + 128];
    if (!text || !text[0]) return;
    const bool sky = strncmp(text, "sun-sky:", 8) == 0; // it has members already
    snprintf(value, sizeof value, "%s%crotation=%.17g,strength=%.9g", text, sky ? ',' : ':',
             (double)choice->rotation * 57.29577951308232, (double)choice->strength);
    words_add(w, " --environment");
    words_add_word(w, value);
}

static void add_lights(struct words *w, const struct viewer *v)
{
    struct ag_scene_info info = { 0 };
    struct ag_light_info light;
    if (!edits_changed_lights(&v->edits) && !edits_changed_environment(&v->edits)) {
        words_add(w, "%s", v->desc->light_words);
        return;
    }
    ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info);
    words_add(w, " --no-scene-lights");
    words_add(w, "%s", v->desc->kept_words);
    add_environment(w, v);
    for (int i = 0; i < info.lights; i++)
        if (ag_scene_get_light(v->desc->scene, i, v->desc->animation, v->time_s, &light) == AG_OK)
            add_light(w, &light.light);
    words_add(w, " --sky ");
    words_add_triple(w, info.sky);
}

bool viewer_command(struct viewer *v, char *out, size_t size)
{
    struct words w = { out, size, 0 };
    if (edits_changed_materials(&v->edits) || edits_changed_instances(&v->edits)) {
        viewer_warn(v, "there is no option for a changed %s: the command cannot render this view",
                    edits_changed_materials(&v->edits) ? "material" : "place of an object");
        return false;
    }
    if (edits_changed_environment(&v->edits) && !environment_text(v)) {
        viewer_warn(v, "there is no option for another use of the environment of the scene's file: "
                       "the command cannot render this view");
        return false;
    }
    if (paint_has(v)) {
        viewer_warn(v, "there is no option for painted light: the command cannot render this view");
        return false;
    }
    words_add(&w, "afterglow render");
    words_add_word(&w, v->desc->scene_name);
    words_add(&w, "%s", v->desc->scene_words);
    words_add(&w, " --gi");
    words_add_word(&w, v->gi);
    const char *options = viewer_frame_options(v);
    if (options) words_add(&w, " --frame-options");
    if (options) words_add_word(&w, options);
    words_add(&w, " --size %dx%d", v->main.width, v->main.height);
    add_camera(&w, v);
    add_lights(&w, v);
    if (!v->auto_exposure) words_add(&w, " --exposure %.9g", (double)v->exposure_ev);
    if (v->time_s != 0.0) words_add(&w, " --time %.17g", v->time_s);
    if (v->debug_view)
        words_add(&w, " --debug-view %s --aov debug", v->debug_view);
    else if (v->layer > 0)
        words_add(&w, " --aov %s", viewer_layers[v->layer]);
    if (w.used < size) return true;
    viewer_warn(v, "the command would be longer than %zu characters", size - 1);
    return false;
}

bool viewer_write(struct viewer *v, const char *path)
{
    const char *layer = v->debug_view ? "debug" : viewer_layers[v->layer];
    const bool done = v->desc->write(v->desc->user, v->main.renderer, v->tonemap, layer, path);
    if (done)
        viewer_say(v, "written: %s", path);
    else
        viewer_warn(v, "%s", ag_context_last_error(v->desc->context));
    return done;
}
