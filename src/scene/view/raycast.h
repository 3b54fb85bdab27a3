// Ray casts against a pose's triangles, for the default camera and sun. Embree is not used here:
// the result would depend on the processor's vector instructions (docs/decisions.md). Rendering
// uses src/trace. Materials are ignored; all triangles are two-sided.
#pragma once

#include "scene/pose.h"

struct raycast_node;
struct raycast_triangle;

struct raycast {
    struct host *host;
    struct raycast_node *nodes;
    struct raycast_triangle *triangles; // in leaf order
    uint32_t node_count, triangle_count;
};

struct raycast_hit {
    float distance;
    vec3s normal; // geometric, unit, from the winding
    bool front;   // the winding is counter-clockwise from the ray's origin
};

// Copies the pose's triangles. raycast_finish accepts a zeroed one.
bool raycast_init(struct raycast *raycast, struct host *host, const struct scene_pose *pose);
void raycast_finish(struct raycast *raycast);

// The nearest hit with 0 < distance < max_distance, in units of the direction's length.
bool raycast_closest(const struct raycast *raycast, vec3s origin, vec3s direction,
                     float max_distance, struct raycast_hit *hit);
// Whether there is any such hit.
bool raycast_blocked(const struct raycast *raycast, vec3s origin, vec3s direction,
                     float max_distance);
