// Ray queries by Embree 3 or 4; the only header over Embree.
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

// Alpha test of a hit. view: as given to the query.
typedef bool embree_solid(const void *geometry, uint32_t triangle, float u, float v,
                          const void *view);

struct embree_geometry {
    const vec3s *positions; // followed by 4 readable bytes: Embree loads 16 at a time
    size_t stride;          // bytes
    uint32_t vertex_count;
    const uint32_t *indices;
    uint32_t triangle_count;
    embree_solid *solid; // NULL: opaque
    const void *user;    // argument of `solid`
};

struct embree *embree_create(struct host *host);
// Geometries are numbered from 0 in the order of the calls. *geometry and its arrays must outlive
// the object.
bool embree_add(struct embree *embree, const struct embree_geometry *geometry);
bool embree_commit(struct embree *embree);
void embree_destroy(struct embree *embree); // accepts NULL

// A record of queries, for benchmarks. Thread-safe; queries beyond the capacity are only counted.
struct logged_ray {
    struct ray ray;
    bool occlusion;
};
struct ray_log {
    struct logged_ray *rays;
    size_t capacity;
    atomic_size_t count;
};
void embree_log(struct embree *embree, struct ray_log *log); // NULL: stop

// Nearest hit. view is passed to `solid`.
bool embree_closest(const struct embree *embree, const struct ray *ray, const void *view,
                    bool coherent, struct ray_hit *hit);
bool embree_occluded(const struct embree *embree, const struct ray *ray);
// Calls `each` for all hits, in no order: also for those of surfaces that coincide.
typedef void embree_hit(void *user, const struct ray_hit *hit);
void embree_all_hits(const struct embree *embree, const struct ray *ray, embree_hit *each,
                     void *user);

// Flushes denormals to 0 on this thread: they cost a hundred times as much. Returns the argument of
// embree_restore_denormals.
unsigned embree_flush_denormals(void);
void embree_restore_denormals(unsigned before);
