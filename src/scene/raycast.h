// Rays against a pose's triangles, for choosing a camera and a sun. Small and own, so that the
// scene module needs no ray tracing library; everything that makes pictures uses src/trace. All
// triangles count, whatever their material, from both sides.
#pragma once

#include "scene/pose.h"

struct raycast_node;
struct raycast_triangle;

struct raycast {
    struct host *host;
    struct raycast_node *nodes;
    struct raycast_triangle *triangles; // in the order of the leaves
    uint32_t node_count, triangle_count;
};

struct raycast_hit {
    float distance;
    vec3s normal; // of the triangle's plane, unit, by its winding
    bool front;   // the ray met the side from which the winding is counter-clockwise
};

// Copies the pose's triangles. raycast_finish accepts a zeroed one.
bool raycast_init(struct raycast *raycast, struct host *host, const struct scene_pose *pose);
void raycast_finish(struct raycast *raycast);

// The nearest triangle with 0 < distance < max_distance, in units of the direction's length.
bool raycast_closest(const struct raycast *raycast, vec3s origin, vec3s direction,
                     float max_distance, struct raycast_hit *hit);
// Whether there is any.
bool raycast_blocked(const struct raycast *raycast, vec3s origin, vec3s direction,
                     float max_distance);
