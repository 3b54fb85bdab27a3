#include "techniques/radiosity/radiosity_statics.h"

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

bool radiosity_statics_init(struct radiosity_statics *out, struct host *host,
                            const struct scene_pose *pose)
{
    const struct scene *scene = pose->scene;
    const size_t count = (size_t)scene->instance_count;
    *out = (struct radiosity_statics){ .host = host, .scene = *scene, .pose = *pose };
    out->pose.scene = &out->scene;
    out->scene.instances = host_alloc(host, count, sizeof *out->scene.instances);
    bool *animated = find_animated(host, scene);
    const bool ok = out->scene.instances && animated;
    if (ok && count > 0)
        memcpy(out->scene.instances, scene->instances, count * sizeof(struct instance));
    for (size_t i = 0; ok && i < count; i++) {
        struct instance *it = &out->scene.instances[i];
        if (it->movable || animated[it->node] || has_animated_joint(scene, it->skin, animated))
            it->mesh = -1;
    }
    host_free(host, animated);
    if (!ok) radiosity_statics_finish(out);
    return ok;
}

void radiosity_statics_finish(struct radiosity_statics *statics)
{
    if (statics->host) host_free(statics->host, statics->scene.instances);
    *statics = (struct radiosity_statics){ 0 };
}
