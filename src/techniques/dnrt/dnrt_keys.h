// Key frames of deformed objects (Giuffrida 2016, section 9.2): moments of an animation, evenly
// from its begin to its end, in whose poses volumes are baked.
#pragma once

#include "scene/pose.h"

// Key frames of the animation that the pose plays; 1 without one.
int dnrt_keys_of(const struct scene_pose *pose, int keys);
// s; key below `keys` ≥ 2. The last one is just before the end, where time wraps around.
float dnrt_key_time(const struct scene_pose *pose, int keys, int key);

// The keys around the pose's time: `part` of the way from `first` to `next`, exactly 0 at a key.
struct dnrt_between {
    int first, next;
    float part;
};
struct dnrt_between dnrt_keys_around(const struct scene_pose *pose, int keys);

// The poses of all keys. dnrt_key_poses_finish accepts zero.
struct dnrt_key_poses {
    struct host *host;
    struct scene_pose *poses; // [count]; NULL: `pose` alone
    int count;
    const struct scene_pose *pose;
};
bool dnrt_key_poses_init(struct dnrt_key_poses *out, struct host *host,
                         const struct scene_pose *pose, int keys);
void dnrt_key_poses_finish(struct dnrt_key_poses *keys);
static inline const struct scene_pose *dnrt_key_pose(const struct dnrt_key_poses *keys, int key)
{
    return keys->poses ? &keys->poses[key] : keys->pose;
}
