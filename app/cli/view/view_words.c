#include "view_words.h"

#include "cli/values.h"
#include "shell/words.h"

static void describe_scene(const struct arguments *a, struct words *w)
{
    if (a->has_scene_scale) words_add(w, " --scene-scale %.9g", (double)a->scene_scale);
    if (a->animation) words_add(w, " --animation");
    if (a->animation) words_add_word(w, a->animation);
}

static void describe_camera(const struct session *session, const struct ag_camera *camera,
                            struct words *w)
{
    const struct arguments *a = session->arguments;
    if (a->has_eye || session->made_up) {
        words_add(w, " --eye ");
        words_add_triple(w, camera->eye);
        words_add(w, " --target ");
        words_add_triple(w, camera->target);
        words_add(w, " --fov %.9g", degrees(camera->vertical_fov_rad));
        return;
    }
    if (a->camera) words_add(w, " --camera");
    if (a->camera) words_add_word(w, a->camera);
    if (a->has_fov) words_add(w, " --fov %.17g", a->fov_deg);
}

static void describe_kept_light(const struct arguments *a, struct words *w)
{
    for (int i = 0; i < a->light_count; i++) {
        if (!a->lights[i].is_area) continue;
        words_add(w, " --light");
        words_add_word(w, a->light_texts[i]);
    }
}

static void describe_environment(const struct arguments *a, struct words *w)
{
    const struct environment_value *value = &a->environment_value;
    if (!a->environment) return;
    if (value->path[0])
        words_add(w, "%s", value->path);
    else
        words_add(w, "sun-sky:elevation=%.17g,azimuth=%.17g,turbidity=%.9g",
                  degrees(value->sky.elevation), degrees(value->sky.azimuth),
                  (double)value->sky.turbidity);
}

static void describe_light(const struct session *session, struct words *w)
{
    const struct arguments *a = session->arguments;
    if (session->made_up_light) {
        words_add(w, " %s", session->light);
        return;
    }
    if (a->no_scene_lights) words_add(w, " --no-scene-lights");
    for (int i = 0; i < a->light_count; i++) {
        words_add(w, " --light");
        words_add_word(w, a->light_texts[i]);
    }
    if (a->environment) words_add(w, " --environment");
    if (a->environment) words_add_word(w, a->environment);
    if (a->has_sky) words_add(w, " --sky ");
    if (a->has_sky) words_add_triple(w, a->sky);
}

void view_words(const struct session *session, const struct ag_camera *camera,
                struct view_words *out)
{
    out->scene[0] = out->camera[0] = out->light[0] = out->kept[0] = out->environment[0] = 0;
    describe_scene(session->arguments, &(struct words){ out->scene, sizeof out->scene, 0 });
    describe_camera(session, camera, &(struct words){ out->camera, sizeof out->camera, 0 });
    describe_light(session, &(struct words){ out->light, sizeof out->light, 0 });
    describe_kept_light(session->arguments, &(struct words){ out->kept, sizeof out->kept, 0 });
    describe_environment(session->arguments,
                         &(struct words){ out->environment, sizeof out->environment, 0 });
}
