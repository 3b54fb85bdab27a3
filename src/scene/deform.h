// Vertices that bend: morph targets, then linear-blend skinning (glTF 2.0, sections 3.7.2.2
// and 3.7.3), in world space, on the CPU.
#pragma once

#include "scene/pose.h"

// Where each instance's joint matrices go, so that instances can be worked on side by side.
struct deformer {
    mat4s *world_from_mesh; // by joint, all skinned instances one after the other
    size_t *joint_offset;   // [instance_count]
};

bool deformer_init(struct deformer *deformer, struct arena *arena, const struct scene *scene);

// Fills pose->deformed from the pose's nodes and morph weights. Allocates nothing.
void deform(struct deformer *deformer, struct scene_pose *pose);
