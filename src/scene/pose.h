// A scene at a time: node transforms and deformed vertices. Skins and morph targets are evaluated
// on the CPU; the GPU, the path tracer and bakes use the same pose.
#pragma once

#include "scene/scene.h"

// Deformed vertices of one instance in world space; NULL positions for rigid instances.
struct deformed_mesh {
    vec3s *positions, *normals;
    vec4s *tangents; // NULL where the mesh has none
};

struct scene_pose {
    const struct scene *scene;
    int animation; // index, −1: the rest pose
    float time_s;
    uint64_t layout;                  // scene->revisions.layout that the arrays belong to
    mat4s *world_from_node;           // [node_count]
    float *morph_weights;             // of all instances, see morph_offset
    size_t *morph_offset;             // [instance_count]
    struct deformed_mesh *deformed;   // [instance_count]
    struct box3 bounds;               // of all instances, world space; empty for an empty scene
    struct pose_workspace *workspace; // owns the arrays; private to pose.c
};

// `animation`: index, or -1 for the rest pose. Time wraps around the animation's duration.
// pose_finish accepts zero.
bool pose_init(struct scene_pose *pose, const struct scene *scene, int animation, float time_s);
// Adapts the arrays to nodes and instances that were added or removed, before pose_update. False
// when out of memory; the pose is then unchanged.
bool pose_follow(struct scene_pose *pose);
// Evaluates an existing pose at another time; allocates nothing.
void pose_update(struct scene_pose *pose, int animation, float time_s);
void pose_finish(struct scene_pose *pose);

// World transform of an instance; identity for deformed ones, whose vertices are in world space.
mat4s pose_world_from_instance(const struct scene_pose *pose, int instance);
// The transform from a node to one of its ancestors, -1 for the world: free of the rounding of what
// is above that.
mat4s pose_ancestor_from_node(const struct scene_pose *pose, int ancestor, int node);
// Whether the instance's transform mirrors it (negative determinant); for a skin, that of its first
// joint.
bool pose_is_mirrored(const struct scene_pose *pose, int instance);

// Hash of all surfaces in world space: equal for poses that show the same.
uint64_t pose_surfaces_hash(const struct scene_pose *pose);

// A light in world space.
struct world_light {
    enum light_type type;
    vec3s position;  // points and spots
    vec3s direction; // unit, from the light; suns and spots
    vec3s intensity; // lux or candela
    float cos_inner, cos_outer;
    float range_m; // 0: unlimited
};
// Punctual lights of the scene, then the sun of its environment.
int pose_light_count(const struct scene_pose *pose);
struct world_light pose_light(const struct scene_pose *pose, int light);

// A camera in world space.
struct world_camera {
    vec3s eye, forward, up; // position, then two orthogonal unit vectors
    float vertical_fov_rad;
    float near_m;
};
struct world_camera pose_camera(const struct scene_pose *pose, int camera);
struct world_camera camera_look_at(vec3s eye, vec3s target, float vertical_fov_rad, float near_m);
