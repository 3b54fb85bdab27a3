// Commands of scripts that change the light of the scene.
#include "script_state.h"

#include "viewer/operations.h"
#include "viewer/scene/changes.h"

#include <string.h>

bool script_light(const struct words *w)
{
    int light = -1, on = 0;
    struct ag_light_info info;
    char word[8] = "";
    if (sscanf(w->rest, "%d %7s", &light, word) == 2 && strcmp(word, "remove") == 0)
        return script_done(w, viewer_remove_light(w->v, light));
    sscanf(w->rest, "%d %d", &light, &on);
    if (!viewer_check(w->v, ag_scene_get_light(w->v->desc->scene, light, w->v->desc->animation,
                                               w->v->time_s, &info)))
        return script_done(w, false);
    info.light.enabled = on != 0;
    return script_done(w, viewer_set_light(w->v, light, &info.light));
}

bool script_environment(const struct words *w)
{
    struct environment_choice choice = w->v->edits.environment;
    float number;
    if (sscanf(w->rest, "strength %f", &number) == 1) {
        choice.strength = number;
    } else if (sscanf(w->rest, "rotation %f", &number) == 1) {
        choice.rotation = number * 0.017453292f;
    } else if (strcmp(w->rest, "none") == 0) {
        choice.source = ENVIRONMENT_NONE;
    } else if (strcmp(w->rest, "scene") == 0) {
        choice.source = ENVIRONMENT_OF_SCENE;
    } else if (strncmp(w->rest, "file ", 5) == 0) {
        choice.source = ENVIRONMENT_FILE;
        snprintf(choice.path, sizeof choice.path, "%s", w->rest + 5);
    } else {
        return script_wrong(
            w->script,
            "environment takes file FILE, none, scene, strength S or rotation DEG:", w->rest);
    }
    return script_done(w, viewer_set_environment(w->v, &choice));
}

bool script_paint(const struct words *w)
{
    struct dab dab;
    float *p = dab.position, *n = dab.normal, *lux = dab.lux;
    if (strcmp(w->rest, "clear") == 0) {
        paint_clear(w->v);
        return true;
    }
    if (sscanf(w->rest, "%f,%f,%f %f,%f,%f %f %f,%f,%f", p, p + 1, p + 2, n, n + 1, n + 2,
               &dab.radius, lux, lux + 1, lux + 2) != 10 ||
        !(dab.radius > 0) || !(lux[0] >= 0) || !(lux[1] >= 0) || !(lux[2] >= 0))
        return script_wrong(w->script,
                            "paint takes X,Y,Z NX,NY,NZ RADIUS R,G,B or clear:", w->rest);
    return script_done(w, paint_dab(w->v, &dab));
}
