// Laws of every bake: its bytes are the same on any number of threads, after interruptions and in
// shards, and its estimate is near.
#pragma once

#include "bake/bake.h"
#include "scene/pose.h"

struct bake_subject {
    const char *gi; // of one technique
    const struct scene_pose *pose;
    size_t least_bytes; // the file has more
};

// It has not run. NULL: it is refused.
struct bake *bake_of_gi(const char *gi, const struct scene_pose *pose, uint64_t seed);

// 1, 2 and 4 threads.
void bake_bytes_check_threads(const struct bake_subject *subject);
// Cancels at the first shares of the work. The bake takes a second or more.
void bake_bytes_check_interruptions(const struct bake_subject *subject, const double shares[3]);
// Two shards.
void bake_bytes_check_shards(const struct bake_subject *subject);
void bake_check_estimate(const struct bake_subject *subject);
