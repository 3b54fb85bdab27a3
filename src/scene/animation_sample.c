// Step, linear and cubic interpolation between keys. Rotations go along the shorter arc (slerp)
// when linear and are normalised when cubic, as glTF 2.0 appendix C says.
#include "scene/animation_sample.h"

#include <math.h>
#include <string.h>

void rest_pose(const struct scene *scene, struct node_local *local, float *morph_weights,
               const size_t *morph_offset)
{
    for (int i = 0; i < scene->node_count; i++) {
        const struct node *node = &scene->nodes[i];
        local[i] = (struct node_local){ node->translation, node->rotation, node->scale, false };
    }
    for (int i = 0; i < scene->instance_count; i++) {
        const struct instance *instance = &scene->instances[i];
        size_t count = (size_t)scene_mesh_of(scene, i)->morph_count;
        if (count > 0 && instance->morph_weights) {
            memcpy(morph_weights + morph_offset[i], instance->morph_weights, count * sizeof(float));
        }
    }
}

// The last key that is not after `time_s`, by bisection; 0 when all are after it.
static int key_before(const struct animation_channel *channel, float time_s)
{
    int low = 0, high = channel->key_count;
    while (high - low > 1) {
        int middle = low + (high - low) / 2;
        if (channel->times_s[middle] <= time_s) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// The value of key k. Cubic keys store in-tangent, value, out-tangent.
static const float *key_value(const struct animation_channel *channel, int k)
{
    size_t width = (size_t)channel->width;
    if (channel->interpolation != INTERPOLATE_CUBIC) return channel->values + (size_t)k * width;
    return channel->values + ((size_t)k * 3 + 1) * width;
}

static versors quaternion_of(const float *values)
{
    return (versors){ { values[0], values[1], values[2], values[3] } };
}

static void slerp_keys(const float *a, const float *b, float u, float *out)
{
    versors result = glms_quat_slerp(glms_quat_normalize(quaternion_of(a)),
                                     glms_quat_normalize(quaternion_of(b)), u);
    memcpy(out, result.raw, sizeof result.raw);
}

static void sample_linear(const struct animation_channel *channel, int k, float u, int count,
                          float *out)
{
    const float *a = key_value(channel, k), *b = key_value(channel, k + 1);
    if (channel->path == PATH_ROTATION) {
        slerp_keys(a, b, u, out);
        return;
    }
    for (int i = 0; i < count; i++) out[i] = a[i] + u * (b[i] - a[i]);
}

// The cubic Hermite spline of appendix C.5. Tangents are per second, hence the factor step_s.
static void sample_cubic(const struct animation_channel *channel, int k, float u, float step_s,
                         int count, float *out)
{
    size_t width = (size_t)channel->width;
    const float *a = key_value(channel, k), *b = key_value(channel, k + 1);
    const float *a_out = a + width, *b_in = b - width;
    float u2 = u * u, u3 = u2 * u;
    for (int i = 0; i < count; i++) {
        out[i] = (2 * u3 - 3 * u2 + 1) * a[i] + step_s * (u3 - 2 * u2 + u) * a_out[i] +
                 (3 * u2 - 2 * u3) * b[i] + step_s * (u3 - u2) * b_in[i];
    }
}

void channel_sample(const struct animation_channel *channel, float time_s, int count, float *out)
{
    int k = key_before(channel, time_s);
    bool between = k + 1 < channel->key_count && time_s > channel->times_s[k];
    float step_s = between ? channel->times_s[k + 1] - channel->times_s[k] : 0.0f;
    float u = step_s > 0.0f ? (time_s - channel->times_s[k]) / step_s : 0.0f;
    if (!between || u <= 0.0f || channel->interpolation == INTERPOLATE_STEP) {
        memcpy(out, key_value(channel, k), (size_t)count * sizeof(float));
    } else if (channel->interpolation == INTERPOLATE_LINEAR) {
        sample_linear(channel, k, u, count, out);
    } else {
        sample_cubic(channel, k, u, step_s, count, out);
    }
    if (channel->path != PATH_ROTATION) return;
    versors rotation = quaternion_of(out);
    float length = glms_quat_norm(rotation);
    if (length > 0.0f) {
        for (int i = 0; i < 4; i++) out[i] /= length;
    } else {
        memcpy(out, (float[4]){ 0, 0, 0, 1 }, 4 * sizeof(float));
    }
}

// Time within one period. A negative time counts back from the end.
float animation_time(float time_s, float duration_s)
{
    if (!(duration_s > 0.0f) || !isfinite(time_s)) return 0.0f;
    float wrapped = fmodf(time_s, duration_s);
    return wrapped < 0.0f ? wrapped + duration_s : wrapped;
}

// A weights channel drives all instances at its node.
static void animate_weights(const struct scene *scene, const struct animation_channel *channel,
                            float time_s, float *morph_weights, const size_t *morph_offset)
{
    for (int i = 0; i < scene->instance_count; i++) {
        if (scene->instances[i].node != channel->node) continue;
        int morph_count = scene_mesh_of(scene, i)->morph_count;
        int count = morph_count < channel->width ? morph_count : channel->width;
        if (count > 0) channel_sample(channel, time_s, count, morph_weights + morph_offset[i]);
    }
}

void animate(const struct scene *scene, const struct animation *animation, float time_s,
             struct node_local *local, float *morph_weights, const size_t *morph_offset)
{
    float at_s = animation_time(time_s, animation->duration_s);
    for (int c = 0; c < animation->channel_count; c++) {
        const struct animation_channel *channel = &animation->channels[c];
        if (channel->key_count < 1) continue;
        struct node_local *target = &local[channel->node];
        switch (channel->path) {
        case PATH_TRANSLATION:
            channel_sample(channel, at_s, 3, target->translation.raw);
            break;
        case PATH_ROTATION:
            channel_sample(channel, at_s, 4, target->rotation.raw);
            break;
        case PATH_SCALE:
            channel_sample(channel, at_s, 3, target->scale.raw);
            break;
        case PATH_WEIGHTS:
            animate_weights(scene, channel, at_s, morph_weights, morph_offset);
            continue;
        }
        target->animated = true;
    }
}
