// The command line that renders what is shown, and its image as a file.
#include "command.h"

#include "operations.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct words {
    char *out;
    size_t size, used;
};

__attribute__((format(printf, 2, 3))) static void add(struct words *w, const char *format, ...)
{
    va_list arguments;
    if (w->used >= w->size) return;
    va_start(arguments, format);
    const int wrote = vsnprintf(w->out + w->used, w->size - w->used, format, arguments);
    va_end(arguments);
    w->used += wrote > 0 ? (size_t)wrote : 0;
}

// In single quotes where a shell would change it.
static void add_word(struct words *w, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "@%+=:,./-_";
    if (word[0] && strspn(word, plain) == strlen(word)) {
        add(w, " %s", word);
        return;
    }
    add(w, " '");
    for (const char *c = word; *c; c++) add(w, *c == '\'' ? "'\\''" : "%c", *c);
    add(w, "'");
}

static void add_triple(struct words *w, const float v[3])
{
    add(w, "%.9g,%.9g,%.9g", (double)v[0], (double)v[1], (double)v[2]);
}

static void add_camera(struct words *w, const struct viewer *v)
{
    float target[3];
    if (!v->look.moved) {
        const char *name = ag_scene_camera_name(v->desc->scene, v->scene_camera);
        if (v->scene_camera >= 0) {
            add(w, " --camera");
            add_word(w, name);
        } else if (v->desc->camera_words[0]) {
            add(w, " %s", v->desc->camera_words);
        }
        return;
    }
    look_target(&v->look, target);
    add(w, " --eye ");
    add_triple(w, v->look.eye);
    add(w, " --target ");
    add_triple(w, target);
    add(w, " --fov %.9g", (double)v->look.fov_deg);
}

static void add_light(struct words *w, const struct ag_light_desc *light)
{
    if (!light->enabled) return;
    if (light->type == AG_LIGHT_SUN) {
        add(w, " --light sun:");
        add_triple(w, light->direction);
    } else {
        add(w, " --light %s:", light->type == AG_LIGHT_POINT ? "point" : "spot");
        add_triple(w, light->position);
    }
    if (light->type == AG_LIGHT_SPOT) {
        add(w, ":");
        add_triple(w, light->direction);
        add(w, ":%.9g:%.9g", (double)light->inner_rad * 57.29577951308232,
            (double)light->outer_rad * 57.29577951308232);
    }
    add(w, ":");
    add_triple(w, light->intensity);
}

static void add_lights(struct words *w, const struct viewer *v)
{
    struct ag_scene_info info = { 0 };
    struct ag_light_info light;
    if (!v->edits.lights_changed) {
        if (v->desc->light_words[0]) add(w, " %s", v->desc->light_words);
        return;
    }
    ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info);
    add(w, " --no-scene-lights");
    for (int i = 0; i < info.lights; i++)
        if (ag_scene_get_light(v->desc->scene, i, v->desc->animation, v->time_s, &light) == AG_OK)
            add_light(w, &light.light);
    add(w, " --sky ");
    add_triple(w, info.sky);
}

bool viewer_command(struct viewer *v, char *out, size_t size)
{
    struct words w = { out, size, 0 };
    if (v->edits.material_count > 0 || v->edits.instance_count > 0) {
        viewer_warn(v, "there is no option for a changed %s: the command cannot render this view",
                    v->edits.material_count > 0 ? "material" : "place of an object");
        return false;
    }
    add(&w, "afterglow render");
    add_word(&w, v->desc->scene_name);
    if (v->desc->scene_words[0]) add(&w, " %s", v->desc->scene_words);
    add(&w, " --gi");
    add_word(&w, v->gi);
    if (v->desc->frame_options) add(&w, " --frame-options");
    if (v->desc->frame_options) add_word(&w, v->desc->frame_options);
    add(&w, " --size %dx%d", v->main.width, v->main.height);
    add_camera(&w, v);
    add_lights(&w, v);
    if (!v->auto_exposure) add(&w, " --exposure %.9g", (double)v->exposure_ev);
    if (v->time_s != 0.0) add(&w, " --time %.17g", v->time_s);
    if (v->layer > 0) add(&w, " --aov %s", viewer_layers[v->layer]);
    if (w.used < size) return true;
    viewer_warn(v, "the command would be longer than %zu characters", size - 1);
    return false;
}

bool viewer_write(struct viewer *v, const char *path)
{
    const bool done =
        v->desc->write(v->desc->user, v->main.renderer, viewer_layers[v->layer], path);
    if (done)
        viewer_say(v, "written: %s", path);
    else
        viewer_warn(v, "cannot write %s: %s", path, ag_context_last_error(v->desc->context));
    return done;
}
