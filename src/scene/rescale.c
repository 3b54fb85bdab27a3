#include "scene/rescale.h"

#include "core/hash.h"

#include <float.h>
#include <math.h>

static void scale_nodes(struct scene *scene, float factor)
{
    const vec3s scale = vec3_of(factor, factor, factor);
    for (int i = 0; i < scene->node_count; i++) {
        struct node *node = &scene->nodes[i];
        if (node->parent >= 0) continue;
        node->translation = glms_vec3_scale(node->translation, factor);
        node->scale = glms_vec3_scale(node->scale, factor);
        node->matrix = glms_mat4_mul(glms_scale_make(scale), node->matrix);
    }
}

static void scale_channel(const struct scene *scene, const struct animation_channel *channel,
                          float factor)
{
    if (channel->path != PATH_TRANSLATION && channel->path != PATH_SCALE) return;
    if (scene->nodes[channel->node].parent >= 0) return;
    const size_t values = channel->interpolation == INTERPOLATE_CUBIC ? 3 : 1;
    const size_t count = (size_t)channel->key_count * (size_t)channel->width * values;
    for (size_t i = 0; i < count; i++) channel->values[i] *= factor;
}

static void scale_animations(const struct scene *scene, float factor)
{
    for (int i = 0; i < scene->animation_count; i++)
        for (int k = 0; k < scene->animations[i].channel_count; k++)
            scale_channel(scene, &scene->animations[i].channels[k], factor);
}

// A length above 0 stays above 0, and finite.
static float scaled_length(float length_m, float factor)
{
    return fminf(fmaxf(length_m * factor, FLT_MIN), FLT_MAX);
}

// Scales of nodes do not apply to them.
static void scale_lights_and_cameras(const struct scene *scene, float factor)
{
    for (int i = 0; i < scene->light_count; i++) {
        struct light *light = &scene->lights[i];
        if (light->range_m > 0.0f) light->range_m = scaled_length(light->range_m, factor);
    }
    for (int i = 0; i < scene->camera_count; i++) {
        struct camera *camera = &scene->cameras[i];
        camera->near_m = scaled_length(camera->near_m, factor);
    }
}

void scene_rescale(struct scene *scene, float factor)
{
    if (factor == 1.0f) return;
    scale_nodes(scene, factor);
    scale_animations(scene, factor);
    scale_lights_and_cameras(scene, factor);
    scene->scale *= factor;
    scene->content_hash = hash_bytes(&factor, sizeof factor, scene->content_hash);
}
