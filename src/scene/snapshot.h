// A copy of a posed scene, for work on another thread while the scene changes: its surfaces, lights
// and materials as they were when it was taken. Images, names and index lists, which never change,
// are those of the scene, which must outlive the copy.
#pragma once

#include "scene/pose.h"

struct scene_snapshot {
    struct host *host;
    struct scene scene; // without cameras and animations
    struct scene_pose pose;
    struct snapshot_mesh *vertices; // of meshes whose arrays may be overwritten
    int vertices_count;
    struct snapshot_deformed *deformed; // [instance_count]
    uint64_t materials;                 // revision
};

// Copies the parts that changed since the last call; a zeroed snapshot, with its host, is empty.
// False without memory: then it is empty again.
bool scene_snapshot_take(struct scene_snapshot *snapshot, const struct scene_pose *pose);
void scene_snapshot_finish(struct scene_snapshot *snapshot); // accepts zero

// Whether all surfaces are where they were, with the materials that they had.
bool scene_snapshot_is_current(const struct scene_snapshot *snapshot,
                               const struct scene_pose *pose);
// Whether an instance shows the same surfaces in both, which need not have it.
bool scene_snapshot_has_instance(const struct scene_snapshot *snapshot,
                                 const struct scene_pose *pose, int instance);
