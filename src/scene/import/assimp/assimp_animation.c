// Skins and node animations through Assimp.
#include "scene/import/assimp/assimp.h"

#include <assimp/cimport.h>

#include <math.h>
#include <string.h>

static bool load_skin(struct assimp *assimp, const struct aiMesh *from, struct skin *skin)
{
    struct import *import = assimp->import;
    size_t count = from->mNumBones;
    skin->joints = import_alloc(import, count, sizeof *skin->joints);
    skin->joint_from_mesh = import_alloc(import, count, sizeof *skin->joint_from_mesh);
    if (!skin->joints || !skin->joint_from_mesh) return false;
    for (size_t b = 0; b < count; b++) {
        const struct aiBone *bone = from->mBones[b];
        skin->joints[b] = assimp_find_node(assimp, &bone->mName);
        if (skin->joints[b] < 0) {
            return host_fail(import->host, FAIL_FORMAT, "%s: bone %s is not a node", import->path,
                             import_printable(bone->mName.data).s);
        }
        skin->joint_from_mesh[b] = assimp_matrix(&bone->mOffsetMatrix);
    }
    skin->joint_count = (int)count;
    return true;
}

bool assimp_load_skins(struct assimp *assimp)
{
    struct import *import = assimp->import;
    struct scene *scene = import->scene;
    unsigned count = assimp->from->mNumMeshes;
    scene->skins = import_alloc(import, count, sizeof *scene->skins);
    if (!scene->skins) return false;
    for (unsigned i = 0; i < count; i++) {
        int mesh = assimp->mesh_of[i];
        if (mesh < 0 || !scene->meshes[mesh].joints) continue;
        if (!load_skin(assimp, assimp->from->mMeshes[i], &scene->skins[scene->skin_count])) {
            return false;
        }
        assimp->skin_of[i] = scene->skin_count++;
    }
    return true;
}

static bool channel_init(struct import *import, struct animation_channel *channel, int node,
                         enum channel_path path, int width, size_t keys)
{
    *channel = (struct animation_channel){ .node = node, .path = path, .width = width };
    channel->interpolation = INTERPOLATE_LINEAR;
    channel->times_s = import_alloc(import, keys, sizeof(float));
    channel->values = import_alloc(import, keys, (size_t)width * sizeof(float));
    return channel->times_s && channel->values;
}

// Adds the key if it is finite and later than the previous one.
static void add_key(struct animation_channel *channel, double time_s, const float *value)
{
    int n = channel->key_count;
    float time = (float)time_s;
    bool usable = isfinite(time) && time >= 0.0f && (n == 0 || time > channel->times_s[n - 1]);
    for (int k = 0; k < channel->width; k++) usable = usable && isfinite(value[k]);
    if (!usable) return;
    channel->times_s[n] = time;
    memcpy(channel->values + n * channel->width, value, (size_t)channel->width * sizeof *value);
    channel->key_count++;
}

static void add_channel(struct animation *animation, const struct animation_channel *channel)
{
    if (channel->key_count == 0) return;
    float end = channel->times_s[channel->key_count - 1];
    animation->duration_s = fmaxf(animation->duration_s, end);
    animation->channels[animation->channel_count++] = *channel;
}

static bool load_vectors(struct import *import, struct animation *animation, int node,
                         enum channel_path path, const struct aiVectorKey *keys, unsigned count,
                         double ticks)
{
    struct animation_channel channel;
    if (!channel_init(import, &channel, node, path, 3, count)) return false;
    for (unsigned i = 0; i < count; i++) {
        float value[3] = { keys[i].mValue.x, keys[i].mValue.y, keys[i].mValue.z };
        add_key(&channel, keys[i].mTime / ticks, value);
    }
    add_channel(animation, &channel);
    return true;
}

static bool load_rotations(struct import *import, struct animation *animation, int node,
                           const struct aiNodeAnim *from, double ticks)
{
    struct animation_channel channel;
    if (!channel_init(import, &channel, node, PATH_ROTATION, 4, from->mNumRotationKeys))
        return false;
    for (unsigned i = 0; i < from->mNumRotationKeys; i++) {
        const struct aiQuaternion *q = &from->mRotationKeys[i].mValue;
        float length = sqrtf(q->x * q->x + q->y * q->y + q->z * q->z + q->w * q->w);
        if (!(length > 0.0f)) continue;
        float value[4] = { q->x / length, q->y / length, q->z / length, q->w / length };
        add_key(&channel, from->mRotationKeys[i].mTime / ticks, value);
    }
    add_channel(animation, &channel);
    return true;
}

// Decomposes the rest transform of an animated node: keys replace its parts.
static void decompose_node(struct assimp *assimp, int node)
{
    struct node *to = &assimp->import->scene->nodes[node];
    struct aiVector3D scale, position;
    struct aiQuaternion rotation;
    aiDecomposeMatrix(&assimp->nodes[node]->mTransformation, &scale, &rotation, &position);
    versors q = { { rotation.x, rotation.y, rotation.z, rotation.w } };
    float length = glms_quat_norm(q);
    if (!to->has_matrix || !(length > 0.0f) || !isfinite(length)) return;
    to->has_matrix = false;
    to->translation = vec3_of(position.x, position.y, position.z);
    to->rotation = glms_quat_normalize(q);
    to->scale = vec3_of(scale.x, scale.y, scale.z);
}

static bool load_animation(struct assimp *assimp, unsigned i)
{
    struct import *import = assimp->import;
    const struct aiAnimation *from = assimp->from->mAnimations[i];
    struct animation *animation = &import->scene->animations[i];
    double ticks =
        from->mTicksPerSecond > 0.0 ? from->mTicksPerSecond : 25.0; // Assimp's convention
    animation->name = import_name(import, from->mName.data, "animation", i);
    animation->channels = import_alloc(import, from->mNumChannels, 3 * sizeof *animation->channels);
    if (!animation->name || !animation->channels) return false;
    if (from->mNumMeshChannels + from->mNumMorphMeshChannels > 0) {
        import_note(import, "vertex animation");
    }
    for (unsigned c = 0; c < from->mNumChannels; c++) {
        const struct aiNodeAnim *channel = from->mChannels[c];
        int node = assimp_find_node(assimp, &channel->mNodeName);
        if (node < 0) continue;
        decompose_node(assimp, node);
        if (!load_vectors(import, animation, node, PATH_TRANSLATION, channel->mPositionKeys,
                          channel->mNumPositionKeys, ticks) ||
            !load_rotations(import, animation, node, channel, ticks) ||
            !load_vectors(import, animation, node, PATH_SCALE, channel->mScalingKeys,
                          channel->mNumScalingKeys, ticks)) {
            return false;
        }
    }
    return true;
}

bool assimp_load_animations(struct assimp *assimp)
{
    struct import *import = assimp->import;
    unsigned count = assimp->from->mNumAnimations;
    import->scene->animations = import_alloc(import, count, sizeof *import->scene->animations);
    if (!import->scene->animations) return false;
    for (unsigned i = 0; i < count; i++) {
        if (!load_animation(assimp, i)) return false;
        import->scene->animation_count++;
    }
    return true;
}
