#include "scene/rescale.h"

#include "core/hash.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

// ---- Vertices. Meshes of a file share arrays, each of which is scaled once.

struct positions {
    vec3s *at;
    uint32_t count;
};

static size_t count_arrays(const struct scene *scene)
{
    size_t count = 0;
    for (int i = 0; i < scene->mesh_count; i++) count += 1 + (size_t)scene->meshes[i].morph_count;
    return count;
}

static void list_arrays(const struct scene *scene, struct positions *out)
{
    for (int i = 0; i < scene->mesh_count; i++) {
        const struct mesh *mesh = &scene->meshes[i];
        *out++ = (struct positions){ mesh->positions, mesh->vertex_count };
        for (int m = 0; m < mesh->morph_count; m++)
            *out++ = (struct positions){ mesh->morphs[m].positions, mesh->vertex_count };
    }
}

static int by_address(const void *a, const void *b)
{
    const struct positions *x = a, *y = b;
    return ((uintptr_t)x->at > (uintptr_t)y->at) - ((uintptr_t)x->at < (uintptr_t)y->at);
}

static bool scale_vertices(struct scene *scene, float factor)
{
    const size_t count = count_arrays(scene);
    struct positions *arrays = host_alloc(scene->host, count, sizeof *arrays);
    if (!arrays) return false;
    list_arrays(scene, arrays);
    qsort(arrays, count, sizeof *arrays, by_address);
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && arrays[i].at == arrays[i - 1].at) continue;
        for (uint32_t v = 0; v < arrays[i].count; v++)
            arrays[i].at[v] = glms_vec3_scale(arrays[i].at[v], factor);
    }
    host_free(scene->host, arrays);
    return true;
}

static void scale_bounds(struct scene *scene, float factor)
{
    for (int i = 0; i < scene->mesh_count; i++) {
        struct box3 *bounds = &scene->meshes[i].bounds;
        if (box3_is_empty(*bounds)) continue;
        bounds->min = glms_vec3_scale(bounds->min, factor);
        bounds->max = glms_vec3_scale(bounds->max, factor);
    }
}

// ---- Transforms

static void scale_translation(mat4s *matrix, float factor)
{
    for (int k = 0; k < 3; k++) matrix->raw[3][k] *= factor;
}

static void scale_nodes(struct scene *scene, float factor)
{
    for (int i = 0; i < scene->node_count; i++) {
        struct node *node = &scene->nodes[i];
        node->translation = glms_vec3_scale(node->translation, factor);
        scale_translation(&node->matrix, factor);
    }
    for (int i = 0; i < scene->skin_count; i++)
        for (int k = 0; k < scene->skins[i].joint_count; k++)
            scale_translation(&scene->skins[i].joint_from_mesh[k], factor);
}

static void scale_channel(const struct animation_channel *channel, float factor)
{
    if (channel->path != PATH_TRANSLATION) return;
    const size_t values = channel->interpolation == INTERPOLATE_CUBIC ? 3 : 1;
    const size_t count = (size_t)channel->key_count * (size_t)channel->width * values;
    for (size_t i = 0; i < count; i++) channel->values[i] *= factor;
}

static void scale_animations(struct scene *scene, float factor)
{
    for (int i = 0; i < scene->animation_count; i++)
        for (int k = 0; k < scene->animations[i].channel_count; k++)
            scale_channel(&scene->animations[i].channels[k], factor);
}

// ---- Lights and cameras

// A length above 0 stays above 0, and finite.
static float scaled_length(float length_m, float factor)
{
    return fminf(fmaxf(length_m * factor, FLT_MIN), FLT_MAX);
}

static void scale_lights_and_cameras(struct scene *scene, float factor)
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

bool scene_rescale(struct scene *scene, float factor)
{
    if (factor == 1.0f) return true;
    if (!scale_vertices(scene, factor)) return false;
    scale_bounds(scene, factor);
    scale_nodes(scene, factor);
    scale_animations(scene, factor);
    scale_lights_and_cameras(scene, factor);
    scene->scale *= factor;
    scene->content_hash = hash_bytes(&factor, sizeof factor, scene->content_hash);
    return true;
}
