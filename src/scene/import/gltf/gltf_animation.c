// Animations of a glTF file (glTF 2.0, section 3.11).
#include "scene/import/gltf/gltf.h"

#include <math.h>
#include <string.h>

struct sampled { // a sampler's arrays in the file
    size_t keys;
    int width;
    const float *times, *values;
};

static bool path_of(const char *text, enum channel_path *path, int *width)
{
    static const struct {
        const char *name;
        enum channel_path path;
        int width; // 0: the number of morph targets
    } paths[] = { { "translation", PATH_TRANSLATION, 3 },
                  { "rotation", PATH_ROTATION, 4 },
                  { "scale", PATH_SCALE, 3 },
                  { "weights", PATH_WEIGHTS, 0 } };
    for (size_t i = 0; text && i < sizeof paths / sizeof *paths; i++) {
        if (strcmp(text, paths[i].name) != 0) continue;
        *path = paths[i].path;
        *width = paths[i].width;
        return true;
    }
    return false;
}

static bool interpolation_of(struct gltf_object sampler, enum channel_interpolation *out)
{
    const char *text = gltf_string(sampler, "interpolation");
    if (!text || strcmp(text, "LINEAR") == 0)
        *out = INTERPOLATE_LINEAR;
    else if (strcmp(text, "STEP") == 0)
        *out = INTERPOLATE_STEP;
    else if (strcmp(text, "CUBICSPLINE") == 0)
        *out = INTERPOLATE_CUBIC;
    else
        return gltf_wrong(sampler, "unknown interpolation");
    return !sampler.gltf->failed;
}

static int morph_count_of(struct gltf *gltf, struct gltf_object node)
{
    int mesh = gltf_index(node, "mesh", gltf->meshes);
    if (mesh < 0 || gltf->mesh_parts[mesh] == 0) return 0;
    return gltf->import->scene->meshes[gltf->first_mesh[mesh]].morph_count;
}

// Copies the keys, which must ascend in time. Of keys at the same time the first is used.
static bool copy_keys(struct gltf_object object, const struct sampled *in,
                      struct animation_channel *out)
{
    size_t stride = (size_t)in->width * (out->interpolation == INTERPOLATE_CUBIC ? 3 : 1);
    for (size_t i = 0; i < in->keys; i++) {
        float time = in->times[i];
        if (!isfinite(time) || time < 0.0f)
            return gltf_wrong(object, "the time of key %zu is negative or not finite", i);
        if (out->key_count > 0 && time <= out->times_s[out->key_count - 1]) {
            if (time == out->times_s[out->key_count - 1]) continue;
            return gltf_wrong(object, "its times do not ascend at key %zu", i);
        }
        const float *values = in->values + i * stride;
        for (size_t k = 0; k < stride; k++) {
            if (!isfinite(values[k])) return gltf_wrong(object, "key %zu is not finite", i);
        }
        memcpy(out->values + (size_t)out->key_count * stride, values, stride * sizeof *values);
        out->times_s[out->key_count++] = time;
    }
    return true;
}

// Normalises rotation keys.
static void unit_rotations(struct animation_channel *channel)
{
    bool cubic = channel->interpolation == INTERPOLATE_CUBIC;
    for (int i = 0; i < channel->key_count; i++) {
        float *q = channel->values + 4 * (cubic ? 3 * i + 1 : i);
        float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        bool usable = length > 0.0f && isfinite(length);
        for (int k = 0; k < 4; k++) q[k] = usable ? q[k] / length : k == 3 ? 1.0f : 0.0f;
    }
}

static bool load_sampler(struct gltf *gltf, struct gltf_object sampler,
                         struct animation_channel *channel)
{
    struct import *import = gltf->import;
    int input = gltf_index(sampler, "input", gltf->accessors);
    int output = gltf_index(sampler, "output", gltf->accessors);
    if (gltf->failed || !interpolation_of(sampler, &channel->interpolation)) return false;
    if (input < 0 || output < 0) return gltf_wrong(sampler, "has no input or no output");
    struct sampled in = { .keys = gltf_accessor_count(gltf, input), .width = channel->width };
    size_t stride = (size_t)in.width * (channel->interpolation == INTERPOLATE_CUBIC ? 3 : 1);
    bool weights = channel->path == PATH_WEIGHTS;
    size_t needed = in.keys * (weights ? stride : stride / (size_t)in.width);
    size_t given = gltf_accessor_count(gltf, output);
    if (gltf->failed) return false;
    if (given != needed)
        return gltf_wrong(sampler, "has %zu values, %zu are needed", given, needed);
    in.times = gltf_floats_of(gltf, input, 1);
    in.values = in.times ? gltf_floats_of(gltf, output, weights ? 1 : in.width) : NULL;
    if (!in.values) return false;
    channel->times_s = import_alloc(import, in.keys, sizeof(float));
    channel->values = import_alloc(import, in.keys, stride * sizeof(float));
    if (!channel->times_s || !channel->values || !copy_keys(sampler, &in, channel)) return false;
    if (channel->path == PATH_ROTATION) unit_rotations(channel);
    return true;
}

static bool load_channel(struct gltf *gltf, json_t *channels, size_t i, json_t *samplers,
                         struct animation *animation)
{
    struct import *import = gltf->import;
    struct gltf_object object = gltf_element(gltf, channels, "animation channel", i);
    struct gltf_object target = gltf_child(object, "target");
    int node = gltf_index(target, "node", gltf->nodes);
    int sampler_index = gltf_index(object, "sampler", samplers);
    const char *path = gltf_string(target, "path");
    struct animation_channel *channel = &animation->channels[animation->channel_count];
    *channel = (struct animation_channel){ 0 };
    if (gltf->failed) return false;
    if (sampler_index < 0) return gltf_wrong(object, "has no sampler");
    if (!path_of(path, &channel->path, &channel->width)) {
        import_note(import, "animation of other targets than nodes");
        return true;
    }
    if (node < 0) return true; // ignored, as glTF 2.0 requires
    struct gltf_object node_object = gltf_element(gltf, gltf->nodes, "node", (size_t)node);
    if (gltf_has(node_object, "matrix")) {
        import_note(import, "animation of nodes that have a matrix");
        return true;
    }
    if (channel->path == PATH_WEIGHTS) channel->width = morph_count_of(gltf, node_object);
    if (channel->width == 0) {
        import_note(import, "animation of weights without morph targets");
        return !gltf->failed;
    }
    channel->node = (int)gltf->scene_node[node];
    struct gltf_object sampler =
        gltf_element(gltf, samplers, "animation sampler", (size_t)sampler_index);
    if (!load_sampler(gltf, sampler, channel)) return false;
    float end = channel->times_s[channel->key_count - 1];
    animation->duration_s = fmaxf(animation->duration_s, end);
    animation->channel_count++;
    return true;
}

static bool load_animation(struct gltf *gltf, size_t i)
{
    struct import *import = gltf->import;
    struct gltf_object object = gltf_element(gltf, gltf->animations, "animation", i);
    json_t *channels = gltf_array(object, "channels");
    json_t *samplers = gltf_array(object, "samplers");
    struct animation *animation = &import->scene->animations[i];
    animation->name = import_name(import, gltf_string(object, "name"), "animation", i);
    animation->channels =
        import_alloc(import, json_array_size(channels), sizeof *animation->channels);
    if (gltf->failed || !animation->name || !animation->channels) return false;
    for (size_t k = 0; k < json_array_size(channels); k++) {
        if (!load_channel(gltf, channels, k, samplers, animation)) return false;
    }
    return true;
}

bool gltf_load_animations(struct gltf *gltf)
{
    struct scene *scene = gltf->import->scene;
    size_t count = json_array_size(gltf->animations);
    scene->animations = import_alloc(gltf->import, count, sizeof *scene->animations);
    if (!scene->animations) return false;
    for (size_t i = 0; i < count; i++) {
        if (!load_animation(gltf, i)) return false;
        scene->animation_count++;
    }
    return true;
}
