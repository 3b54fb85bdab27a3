#include "techniques/dnrt/dnrt_keys.h"

#include "scene/animation_sample.h"

#include <math.h>

static float duration_of(const struct scene_pose *pose)
{
    return pose->animation >= 0 ? pose->scene->animations[pose->animation].duration_s : 0.0f;
}

int dnrt_keys_of(const struct scene_pose *pose, int keys)
{
    return duration_of(pose) > 0.0f ? keys : 1;
}

float dnrt_key_time(const struct scene_pose *pose, int keys, int key)
{
    const float end = duration_of(pose);
    return fminf(end * (float)key / (float)(keys - 1), nextafterf(end, 0.0f));
}

struct dnrt_between dnrt_keys_around(const struct scene_pose *pose, int keys)
{
    struct dnrt_between at = { 0, 0, 0.0f };
    if (dnrt_keys_of(pose, keys) < 2) return at;
    const float time = animation_time(pose->time_s, duration_of(pose));
    while (at.first < keys - 2 && dnrt_key_time(pose, keys, at.first + 1) <= time) at.first++;
    at.next = at.first + 1;
    const float first = dnrt_key_time(pose, keys, at.first);
    at.part = (time - first) / (dnrt_key_time(pose, keys, at.next) - first);
    if (at.part >= 1.0f) at = (struct dnrt_between){ at.next, at.next, 0.0f };
    return at;
}

bool dnrt_key_poses_init(struct dnrt_key_poses *out, struct host *host,
                         const struct scene_pose *pose, int keys)
{
    *out = (struct dnrt_key_poses){ .host = host, .count = dnrt_keys_of(pose, keys), .pose = pose };
    if (out->count < 2) return true;
    out->poses = host_alloc(host, (size_t)out->count, sizeof *out->poses);
    for (int key = 0; out->poses && key < out->count; key++)
        if (!pose_init(&out->poses[key], pose->scene, pose->animation,
                       dnrt_key_time(pose, out->count, key)))
            return false;
    return out->poses != NULL;
}

void dnrt_key_poses_finish(struct dnrt_key_poses *keys)
{
    if (!keys->host) return;
    for (int key = 0; keys->poses && key < keys->count; key++) pose_finish(&keys->poses[key]);
    host_free(keys->host, keys->poses);
    *keys = (struct dnrt_key_poses){ 0 };
}
