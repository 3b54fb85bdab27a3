#include "techniques/radiosity/radiosity_statics.h"

#include "scene/dynamic.h"

#include <string.h>

bool radiosity_statics_init(struct radiosity_statics *out, struct host *host,
                            const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    const size_t count = (size_t)scene->instance_count;
    *out = (struct radiosity_statics){ .host = host, .scene = *scene, .pose = *pose };
    out->pose.scene = &out->scene;
    out->scene.instances = host_alloc(host, count, sizeof *out->scene.instances);
    bool *dynamic = scene_dynamic_instances(host, scene);
    const bool ok = out->scene.instances && dynamic;
    if (ok && count > 0)
        memcpy(out->scene.instances, scene->instances, count * sizeof(struct instance));
    for (size_t i = 0; ok && i < count; i++)
        if (dynamic[i]) out->scene.instances[i].mesh = -1;
    host_free(host, dynamic);
    if (!ok) radiosity_statics_finish(out);
    return ok;
}

void radiosity_statics_finish(struct radiosity_statics *statics)
{
    if (statics->host) host_free(statics->host, statics->scene.instances);
    *statics = (struct radiosity_statics){ 0 };
}
