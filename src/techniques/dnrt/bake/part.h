// An object as a scene of its own, in its frame, against which rays are traced.
#pragma once

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
