#include "scene/dynamic.h"

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
