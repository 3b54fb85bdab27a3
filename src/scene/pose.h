// A scene at a moment: where each node is, and the vertices of what bends. Skins and morph targets
// are evaluated on the CPU. The same pose feeds the GPU, the path tracer and the bakes.
#pragma once

#include "scene/scene.h"

// Deformed vertices of one instance in world space; NULL positions for rigid instances.
struct deformed_mesh {
    vec3s *positions, *normals;
    vec4s *tangents; // NULL where the mesh has none
};

struct scene_pose {
    const struct scene *scene;
    float time_s;
    mat4s *world_from_node;           // [node_count]
    float *morph_weights;             // all instances', see morph_offset
    size_t *morph_offset;             // [instance_count]
    struct deformed_mesh *deformed;   // [instance_count]
    struct box3 bounds;               // of all instances, world space; empty for an empty scene
    struct pose_workspace *workspace; // owns all of the above; pose.c's own
};

// `animation`: index, or -1 for the rest pose. Time wraps around the animation's duration.
// pose_finish accepts zero.
bool pose_init(struct scene_pose *pose, const struct scene *scene, int animation, float time_s);
// Moves an existing pose to another time; allocates nothing.
void pose_update(struct scene_pose *pose, int animation, float time_s);
void pose_finish(struct scene_pose *pose);

// World transform of an instance (identity for skinned ones, whose vertices are in world space
// already).
mat4s pose_world_from_instance(const struct scene_pose *pose, int instance);
// Whether an instance's triangles are turned over by its transform; of a skin, the first joint
// decides.
bool pose_is_mirrored(const struct scene_pose *pose, int instance);

// A light in world space.
struct world_light {
    enum light_type type;
    vec3s position;  // points and spots
    vec3s direction; // unit, the way the light shines; suns and spots
    vec3s intensity; // lux or candela
    float cos_inner, cos_outer;
    float range_m; // 0: unlimited
};
struct world_light pose_light(const struct scene_pose *pose, int light);

// A camera in world space. fov is vertical.
struct world_camera {
    vec3s eye, forward, up; // forward and up are unit and orthogonal
    float vertical_fov_rad;
    float near_m;
};
struct world_camera pose_camera(const struct scene_pose *pose, int camera);
struct world_camera camera_look_at(vec3s eye, vec3s target, float vertical_fov_rad, float near_m);
