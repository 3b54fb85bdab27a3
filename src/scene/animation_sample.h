// Evaluates animation channels over a scene's rest pose (glTF 2.0, section 3.11 and appendix C).
#pragma once

#include "scene/scene.h"

// Translation, rotation and scale of a node in its parent's space.
struct node_local {
    vec3s translation;
    versors rotation;
    vec3s scale;
    bool animated; // a channel replaced one of them
};

// Fills local[node_count] and the morph weights of every instance from the scene itself.
void rest_pose(const struct scene *scene, struct node_local *local, float *morph_weights,
               const size_t *morph_offset);

// A time within an animation's duration: it wraps around; 0 without a duration.
float animation_time(float time_s, float duration_s);

// Replaces the animated values. Time wraps around the animation's duration.
void animate(const struct scene *scene, const struct animation *animation, float time_s,
             struct node_local *local, float *morph_weights, const size_t *morph_offset);

// The channel's value at a time: `count` ≤ width floats, clamped to the first and the last key.
// Rotations are unit quaternions.
void channel_sample(const struct animation_channel *channel, float time_s, int count, float *out);
