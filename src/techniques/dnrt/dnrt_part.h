// An object as a scene of its own, in its frame, against which rays are traced.
#pragma once

#include "core/hash.h"
#include "techniques/dnrt/dnrt_keys.h"
#include "techniques/dnrt/dnrt_object.h"

// Images, names and index lists are those of the posed scene, which outlives the part.
struct dnrt_part {
    struct host *host;
    struct scene scene; // without lights
    struct scene_pose pose;
    vec3s centre;    // of the bounding sphere, the paper's centroid, m
    float radius;    // m; 0: there is no triangle
    struct box3 box; // of its vertices
};

// dnrt_part_finish accepts zero.
bool dnrt_part_init(struct dnrt_part *out, struct host *host, const struct scene_pose *pose,
                    const struct dnrt_objects *objects, int object);
void dnrt_part_finish(struct dnrt_part *part);

// Content of each volume's part, the same wherever its objects are and in whatever scene:
// [volume_count], which the caller frees. keys: of the option. NULL without memory.
struct hash128 *dnrt_volume_keys(struct host *host, const struct dnrt_objects *objects,
                                 const struct scene_pose *pose, int keys);
// The pose in which a volume is baked.
const struct scene_pose *dnrt_pose_of_volume(const struct dnrt_objects *objects,
                                             const struct dnrt_key_poses *keys, int volume);

enum { DNRT_NAME_SIZE = 64 };
// The name of the tensor of a key, of a format of dnrt_tensors.h.
void dnrt_tensor_name(const char *format, struct hash128 key, char out[DNRT_NAME_SIZE]);
