// Dynamic objects: groups of instances at one node that move rigidly, and deformed instances. Each
// has a frame of its own, in which its volume is baked.
#pragma once

#include "scene/pose.h"
#include "techniques/dnrt/dnrt_deformed.h"

// world_from_object = translation · rotation · scale.
struct dnrt_frame {
    vec3s origin;   // m
    mat3s rotation; // proper
    float scale;    // > 0
};
mat4s dnrt_world_from_object(const struct dnrt_frame *frame);

// A matrix is rotation · scale · stretch, of which the frame has all but the stretch: symmetric,
// with a determinant of 1, or −1 where the matrix mirrors, rounded to 1/4096. Objects of the same
// mesh and stretch share a volume. False: the matrix has no inverse.
bool dnrt_frame_of(mat4s world_from_mesh, struct dnrt_frame *frame, mat3s *stretch);

// Instances at a node, numbered one after another.
struct dnrt_object {
    int node;
    bool deformed;         // skinned or morphed
    struct dnrt_root root; // of a deformed one
    int first, count;      // in dnrt_objects.instances
    int shape;             // in dnrt_objects.shapes
};

// The unit of the bake: all objects of these meshes and this stretch share it.
struct dnrt_shape {
    int object;       // stands for it
    int first, count; // in dnrt_objects.meshes
    int volume, keys; // its first volume, and their number: of the key frames of a deformed one
    bool deformed;
    mat3s stretch;
};

struct dnrt_objects {
    struct host *host;
    int *instances; // of the scene, object after object
    int *meshes;    // of the scene, shape after shape
    struct dnrt_object *at;
    int count;
    struct dnrt_shape *shapes;
    int shape_count;
    int volume_count;
};

// The objects of a scene: instances that are movable, or that an animation moves or deforms. The
// same scene gives the same objects and shapes wherever they are. keys: of dnrt_keys.h. all: all
// instances, as of an asset. dnrt_objects_finish accepts zero.
bool dnrt_objects_init(struct dnrt_objects *out, struct host *host, const struct scene_pose *pose,
                       int keys, bool all);
void dnrt_objects_finish(struct dnrt_objects *objects);
// The shape of `of` that another scene's, or a later pose's, object has; −1: none.
int dnrt_find_shape(const struct dnrt_objects *of, const struct dnrt_objects *objects,
                    const struct scene_pose *pose, int object);

// The shape that has a volume.
int dnrt_shape_of_volume(const struct dnrt_objects *objects, int volume);

// The frame of an object in a pose, and its stretch. A deformed one turns with its root. False: its
// matrix has no inverse.
bool dnrt_object_frame(const struct dnrt_objects *objects, const struct scene_pose *pose,
                       int object, struct dnrt_frame *frame, mat3s *stretch);
