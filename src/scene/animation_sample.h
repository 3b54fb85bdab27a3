// Animation channels at a time (glTF 2.0, section 3.11 and appendix C), onto a scene's rest pose.
#pragma once

#include "scene/scene.h"

// A node's transform in its parent's space, in parts.
struct node_local {
    vec3s translation;
    versors rotation;
    vec3s scale;
    bool animated; // some channel set a part
};

// Fills local[node_count] and the morph weights of every instance from the scene itself.
void rest_pose(const struct scene *scene, struct node_local *local, float *morph_weights,
               const size_t *morph_offset);

// Lays an animation over what is there. Time wraps around its duration.
void animate(const struct scene *scene, const struct animation *animation, float time_s,
             struct node_local *local, float *morph_weights, const size_t *morph_offset);

// One channel's value at a time, `count` ≤ width floats: the first key's before it, the last one's
// after it. Rotations come out as unit quaternions.
void channel_sample(const struct animation_channel *channel, float time_s, int count, float *out);
