#include "scene/statics.h"

#include <string.h>

// [node_count] nodes that an animation moves, or whose morph weights it changes. Parents come
// first.
static bool *find_animated(struct host *host, const struct scene *scene)
{
    bool *animated = host_alloc(host, (size_t)scene->node_count, sizeof *animated);
    for (int a = 0; animated && a < scene->animation_count; a++)
        for (int c = 0; c < scene->animations[a].channel_count; c++)
            animated[scene->animations[a].channels[c].node] = true;
    for (int n = 0; animated && n < scene->node_count; n++)
        animated[n] |= scene->nodes[n].parent >= 0 && animated[scene->nodes[n].parent];
    return animated;
}

static bool has_animated_joint(const struct scene *scene, int skin, const bool *animated)
{
    for (int j = 0; skin >= 0 && j < scene->skins[skin].joint_count; j++)
        if (animated[scene->skins[skin].joints[j]]) return true;
    return false;
}

bool *scene_dynamic_instances(struct host *host, const struct scene *scene)
{
    bool *dynamic = host_alloc(host, (size_t)scene->instance_count, sizeof *dynamic);
    bool *animated = find_animated(host, scene);
    for (int i = 0; dynamic && animated && i < scene->instance_count; i++) {
        const struct instance *it = &scene->instances[i];
        dynamic[i] =
            it->movable || animated[it->node] || has_animated_joint(scene, it->skin, animated);
    }
    if (!animated) {
        host_free(host, dynamic);
        dynamic = NULL;
    }
    host_free(host, animated);
    return dynamic;
}

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
