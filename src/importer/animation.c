// Animations of nodes. Keys that are not finite or not later than the last one are left out.
#include "importer/importer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct track {
    float *times, *values;
    int width;
    size_t count;
};

static struct track track_begin(unsigned keys, int width)
{
    return (struct track){ allocate(keys, sizeof(float)),
                           allocate(keys, (size_t)width * sizeof(float)), width, 0 };
}

static void add_key(struct track *track, double time_s, const float *value)
{
    float time = (float)time_s;
    bool usable = isfinite(time) && time >= 0.0f &&
                  (track->count == 0 || time > track->times[track->count - 1]);
    for (int k = 0; k < track->width; k++) usable = usable && isfinite(value[k]);
    if (!usable) return;
    memcpy(track->values + track->count * (size_t)track->width, value,
           (size_t)track->width * sizeof *value);
    track->times[track->count++] = time;
}

struct animation {
    struct importer *importer;
    json_t *channels, *samplers;
    int node;
    double ticks; // per second
};

static void add_channel(struct animation *a, const char *path, struct track *track)
{
    struct glb *glb = &a->importer->glb;
    if (track->count > 0) {
        size_t input = glb_add_accessor(glb, track->times, GLB_FLOAT, "SCALAR", track->count);
        size_t output = glb_add_accessor(glb, track->values, GLB_FLOAT,
                                         track->width == 4 ? "VEC4" : "VEC3", track->count);
        json_t *sampler =
            json_pack("{s:I, s:I}", "input", (json_int_t)input, "output", (json_int_t)output);
        json_array_append_new(a->channels, json_pack("{s:I, s:{s:i, s:s}}", "sampler",
                                                     (json_int_t)json_array_size(a->samplers),
                                                     "target", "node", a->node, "path", path));
        json_array_append_new(a->samplers, sampler);
    }
    free(track->times);
    free(track->values);
}

static void add_vectors(struct animation *a, const char *path, const struct aiVectorKey *keys,
                        unsigned count)
{
    struct track track = track_begin(count, 3);
    for (unsigned i = 0; i < count; i++) {
        const float value[3] = { keys[i].mValue.x, keys[i].mValue.y, keys[i].mValue.z };
        add_key(&track, keys[i].mTime / a->ticks, value);
    }
    add_channel(a, path, &track);
}

static void add_rotations(struct animation *a, const struct aiQuatKey *keys, unsigned count)
{
    struct track track = track_begin(count, 4);
    for (unsigned i = 0; i < count; i++) {
        const struct aiQuaternion *q = &keys[i].mValue;
        const float value[4] = { q->x, q->y, q->z, q->w };
        if (q->x != 0.0f || q->y != 0.0f || q->z != 0.0f || q->w != 0.0f)
            add_key(&track, keys[i].mTime / a->ticks, value);
    }
    add_channel(a, "rotation", &track);
}

static void import_animation(struct importer *importer, const struct aiAnimation *from)
{
    struct animation a = { .importer = importer, .channels = json_array() };
    a.samplers = json_array();
    a.ticks = from->mTicksPerSecond > 0.0 ? from->mTicksPerSecond : 25.0; // Assimp's convention
    if (from->mNumMeshChannels + from->mNumMorphMeshChannels > 0) output_note("vertex animation");
    for (unsigned c = 0; c < from->mNumChannels; c++) {
        const struct aiNodeAnim *channel = from->mChannels[c];
        a.node = importer_find_node(importer, &channel->mNodeName);
        if (a.node < 0) continue;
        importer->animated[a.node] = true;
        add_vectors(&a, "translation", channel->mPositionKeys, channel->mNumPositionKeys);
        add_rotations(&a, channel->mRotationKeys, channel->mNumRotationKeys);
        add_vectors(&a, "scale", channel->mScalingKeys, channel->mNumScalingKeys);
    }
    glb_add(&importer->glb, "animations",
            json_pack("{s:o, s:o, s:o}", "name", glb_text(from->mName.data), "channels", a.channels,
                      "samplers", a.samplers));
}

void import_animations(struct importer *importer)
{
    importer->animated = allocate(importer->node_count, sizeof *importer->animated);
    for (unsigned i = 0; i < importer->from->mNumAnimations; i++)
        import_animation(importer, importer->from->mAnimations[i]);
}
