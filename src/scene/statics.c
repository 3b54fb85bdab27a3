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

static void free_reflectance(struct material *m)
{
    const bool opaque = m->alpha_mode == ALPHA_OPAQUE;
    m->base_color = vec4_of(vec3_of(1, 1, 1), opaque ? 1.0f : m->base_color.w);
    m->metallic = m->roughness = m->specular = 1.0f;
    m->ior = 0.0f; // F0 = 1
    m->specular_color = vec3_of(1, 1, 1);
    m->unlit = false;
}

bool scene_statics_free_factors(struct scene_statics *s, bool reflectance)
{
    const size_t count = (size_t)s->scene.material_count;
    struct material *materials = host_alloc(s->host, count, sizeof *materials);
    if (!materials || !emission_basis_init(&s->emission, s->host, &s->pose)) {
        host_free(s->host, materials);
        return false;
    }
    if (count > 0) memcpy(materials, s->scene.materials, count * sizeof *materials);
    for (size_t i = 0; i < count; i++) {
        materials[i].emissive = emission_basis_unit(&s->emission, &s->scene, (int)i);
        if (reflectance) free_reflectance(&materials[i]);
    }
    s->scene.materials = s->materials = materials;
    return true;
}

void scene_statics_finish(struct scene_statics *statics)
{
    if (statics->host) {
        host_free(statics->host, statics->scene.instances);
        host_free(statics->host, statics->materials);
    }
    emission_basis_finish(&statics->emission);
    *statics = (struct scene_statics){ 0 };
}
