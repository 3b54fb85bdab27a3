// Embree, versions 3 and 4: the one place that knows it, and the difference.
#pragma once

#include "core/host.h"
#include "core/vec.h"

#include <stdatomic.h>
#include <stdint.h>

struct embree;

struct ray {
    vec3s origin, direction; // the direction need not be unit
    float near, far;         // in lengths of the direction
};

struct ray_hit {
    float distance; // in lengths of the direction
    uint32_t geometry, triangle;
    float u, v; // weights of the triangle's second and third corner
};

// Whether a triangle is there at a point. `view`: what the ray was shot with.
typedef bool embree_solid(const void *geometry, uint32_t triangle, float u, float v,
                          const void *view);

struct embree_geometry {
    const vec3s
        *positions; // the first of them; 4 more bytes follow the last: Embree reads 16 at a time
    size_t stride;  // from one to the next, bytes
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t triangle_count;
    embree_solid *solid; // NULL: everywhere
    const void *user;    // given to `solid`
};

struct embree *embree_create(struct host *host);
// Geometries are numbered from 0 in the order of the calls. *geometry and its arrays must outlive
// the object.
bool embree_add(struct embree *embree, const struct embree_geometry *geometry);
bool embree_commit(struct embree *embree);
void embree_destroy(struct embree *embree); // accepts NULL

// Queries as they were made, for those who measure. From many threads at a time; what there is no
// room for is only counted.
struct logged_ray {
    struct ray ray;
    bool occlusion;
};
struct ray_log {
    struct logged_ray *rays;
    size_t capacity;
    atomic_size_t count;
};
void embree_log(struct embree *embree, struct ray_log *log); // NULL: no longer

// view is handed to the `solid` of what the ray meets. Nearest first.
bool embree_closest(const struct embree *embree, const struct ray *ray, const void *view,
                    bool coherent, struct ray_hit *hit);
bool embree_occluded(const struct embree *embree, const struct ray *ray);

// Numbers too small for a normal float become 0 on this thread: they cost a hundred times as much
// and carry nothing. Returns what embree_restore_denormals takes.
unsigned embree_flush_denormals(void);
void embree_restore_denormals(unsigned before);
