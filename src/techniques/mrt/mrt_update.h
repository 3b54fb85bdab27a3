// Light of emitters and operators, of other materials and of clutter that moved, made by another
// thread while frames use the old ones.
//
// The thread works on a copy of the scene (scene/snapshot.h) and without the GPU: it plans a run
// time (gpu/upload.h), whose content frames copy in parts. The frame with the last part takes
// the new run time, whole. Changes meanwhile wait for the next turn: the newest pose counts.
#pragma once

#include "scene/snapshot.h"

#include "techniques/common/light_map/moves.h"
#include "techniques/mrt/objects/delta_cache.h"
#include "techniques/mrt/gpu/upload.h"

#include <pthread.h>
#include <stdatomic.h>

struct mrt;
struct mrt_parts;

enum mrt_update_state { MRT_IDLE, MRT_RUNNING, MRT_COPYING };

struct mrt_update {
    // The thread's host, with memory of libc: an allocator of the program is called only on the
    // thread of the program.
    struct host host;
    char error[256];
    enum mrt_update_state state;
    pthread_t thread;
    atomic_bool stop, done;
    bool waits;      // frames wait for the thread
    bool waited_for; // by the frame that started it
    bool ok;         // of the thread
    struct scene_snapshot snapshot;
    struct mrt_delta_cache cache;
    struct mrt_parts *parts; // being made
    struct mrt_runtime next;
    struct mrt_plan plan;
    struct light_map_places places, next_places; // of the operators, of those being copied
    const struct scene_pose *pose;               // of the frame
    double seconds;                              // the last one took
    bool *changed; // [changed_count]: instances, since the operators before
    int changed_count;
    bool warned_walls, warned_failure;
};

bool mrt_update_init(struct mrt *mrt, const struct scene_pose *pose);
void mrt_update_finish(struct mrt *mrt); // accepts zero
// After a failure with memory of the update: gives its message to the technique's host. False.
bool mrt_update_pass_on(struct mrt *mrt);

// Before a frame: accepts results of the thread, and starts it if the scene has changed. With
// update=wait, or if the program wants it, it waits. After a failure the old operators stay, with
// one warning.
void mrt_update_follow(struct mrt *mrt, const struct scene_pose *pose, bool wait);
// The same of mrt, which follows materials alone and keeps no copy of the scene before one changes.
bool mrt_update_follow_materials(struct mrt *mrt, const struct scene_pose *pose, bool wait);
// In a frame: copies; true: the operators are new from now on.
bool mrt_update_record(struct mrt *mrt, struct gpu_cmd *cmd);
