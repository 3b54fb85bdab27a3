// Vertices of a pose as receivers: each is a distinct position and normal of an instance; vertices
// that differ in other attributes are one. Double-sided materials have one for each side.
#pragma once

#include "scene/pose.h"

#define PRT_NO_VERTEX UINT32_MAX

struct prt_vertex {
    int instance;
    vec3s position, normal; // world; normal: unit, shading, of its side
};

struct prt_vertices {
    struct host *host;
    struct prt_vertex *at; // [count] all fronts, then the backs
    uint32_t count, front_count;
    size_t *triangle_0; // [instances + 1] first triangle of an instance
    size_t triangle_count;
    uint32_t (*corners)[3]; // [2][triangle_count] vertices of a side; PRT_NO_VERTEX: it has no back
    vec3s *face; // [triangle_count] unit normals of the fronts; 0: a triangle without area
    // The corners at each vertex, 3 · (side · triangle_count + triangle) + corner.
    size_t *fan_0; // [count + 1] in `fan`
    size_t *fan;
};

// FAIL_MEMORY: too many triangles. prt_vertices_finish accepts zero.
bool prt_vertices_init(struct prt_vertices *out, struct host *host, const struct scene_pose *pose);
void prt_vertices_finish(struct prt_vertices *vertices);

// The vertices of a triangle of an instance's mesh.
static inline const uint32_t *prt_vertices_of(const struct prt_vertices *v, int instance,
                                              uint32_t triangle, bool back)
{
    return v->corners[(back ? v->triangle_count : 0) + v->triangle_0[instance] + triangle];
}

// [count] nearest valid vertex of each: itself, or where `hidden` the nearest along edges that is
// not; itself where all are. Owned by the caller.
uint32_t *prt_vertices_fill(const struct prt_vertices *vertices, const bool *hidden);
