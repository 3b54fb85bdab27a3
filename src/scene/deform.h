// Morph targets, then linear-blend skinning (glTF 2.0, sections 3.7.2.2 and 3.7.3), into world
// space, on the CPU.
#pragma once

#include "scene/pose.h"

// Joint matrices of each instance, separate so that instances can be deformed in parallel.
struct deformer {
    mat4s *world_from_mesh; // per joint, concatenated over all skinned instances
    size_t *joint_offset;   // [instance_count]
};

bool deformer_init(struct deformer *deformer, struct arena *arena, const struct scene *scene);

// Morphs a mesh by weights [morph_count], then transforms its vertices by the matrices of its
// joints, which may be NULL: by world_from_node. out: arrays of vertex_count; tangents may be NULL.
void deform_vertices(const struct mesh *mesh, const float *weights, const mat4s *joints,
                     mat4s world_from_node, const struct deformed_mesh *out);

// Fills pose->deformed from the pose's nodes and morph weights. Allocates nothing.
void deform(struct deformer *deformer, struct scene_pose *pose);
