// A renderer follows the changes of its scene before each frame.
#include "api/renderer/scene.h"

#include "api/renderer/state.h"

uint32_t renderer_scene_changes(struct ag_renderer *r)
{
    const struct scene_revisions *now = &r->scene->scene->revisions, *seen = &r->seen;
    uint32_t changes = 0;
    if (now->statics != seen->statics) changes |= CHANGED_GEOMETRY;
    if (now->instances != seen->instances || now->transforms != seen->transforms ||
        now->vertices != seen->vertices)
        changes |= CHANGED_MOVABLE;
    if (now->materials != seen->materials) changes |= CHANGED_MATERIAL;
    if (now->lights != seen->lights) changes |= CHANGED_LIGHT;
    r->seen = *now;
    return changes;
}

// Once for each renderer.
static void warn_of_limit(struct ag_renderer *r)
{
    const struct scene *scene = r->scene->scene;
    int on = pose_light_count(&r->pose) - scene->light_count;
    for (int i = 0; i < scene->light_count; i++) on += !scene->lights[i].off;
    if (on <= FRAME_MAX_LIGHTS || r->said_limit) return;
    r->said_limit = true;
    host_log(renderer_host(r), LOG_WARNING, "%s has %d lights: the first %d are used", scene->name,
             on, FRAME_MAX_LIGHTS);
}

int renderer_scene_lights(struct ag_renderer *r)
{
    const struct scene *scene = r->scene->scene;
    const int suns = pose_light_count(&r->pose) - scene->light_count;
    const int most = FRAME_MAX_LIGHTS - suns;
    int count = 0;
    warn_of_limit(r);
    for (int i = 0; i < scene->light_count && count < most; i++) {
        if (scene->light_count > most && scene->lights[i].off) continue;
        r->lights[count++] = pose_light(&r->pose, i);
    }
    if (suns > 0) r->lights[count++] = pose_light(&r->pose, scene->light_count);
    return count;
}
