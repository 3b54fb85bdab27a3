// Axes of deformed objects, and their vertices along these axes.
#pragma once

#include "scene/deform.h"

// The node whose turns a deformed object follows: the lowest common ancestor of the joints that its
// vertices are bound to, or without a skin its own node. −1: joints have none in common.
struct dnrt_root {
    int node;
    mat4s from_mesh; // the inverse bind matrix of a joint, else the identity
};
// False: out of memory.
bool dnrt_find_root(struct host *host, const struct scene *scene, int instance,
                    struct dnrt_root *out);

// The root's transform of the bind pose to the world, but with the origin in the mean of the
// vertices: parts that move away from the root, as a raised arm, take it along by their share.
mat4s dnrt_world_from_deformed(const struct scene_pose *pose, int instance,
                               const struct dnrt_root *root);

// The deformed vertices and normals along the root's axes of the bind pose, from the vertices'
// mean; where the object is in the world does not change a bit of them. out: arrays of
// vertex_count; no tangents. False: out of memory.
bool dnrt_deformed_mesh(struct host *host, const struct scene_pose *pose, int instance,
                        const struct dnrt_root *root, const struct deformed_mesh *out);
