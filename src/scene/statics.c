#include "scene/statics.h"

#include "scene/dynamic.h"

#include <string.h>

bool scene_statics_init(struct scene_statics *out, struct host *host, const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    const size_t count = (size_t)scene->instance_count;
    *out = (struct scene_statics){ .host = host, .scene = *scene, .pose = *pose };
    out->pose.scene = &out->scene;
    out->scene.instances = host_alloc(host, count, sizeof *out->scene.instances);
    bool *dynamic = scene_dynamic_instances(host, scene);
    const bool ok = out->scene.instances && dynamic;
    if (ok && count > 0)
        memcpy(out->scene.instances, scene->instances, count * sizeof(struct instance));
    for (size_t i = 0; ok && i < count; i++)
        if (dynamic[i]) out->scene.instances[i].mesh = -1;
    host_free(host, dynamic);
    if (!ok) scene_statics_finish(out);
    return ok;
}

void scene_statics_finish(struct scene_statics *statics)
{
    if (statics->host) host_free(statics->host, statics->scene.instances);
    *statics = (struct scene_statics){ 0 };
}
