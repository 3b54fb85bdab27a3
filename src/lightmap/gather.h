// Irradiance of light-map texels by the path tracer. A texel is sampled at points that are spread
// over the part of its square that the surface covers, without those that are inside of something.
#pragma once

#include "scene/charts/charts.h"
#include "trace/path.h"

// gather_scene_finish accepts zero. pose and charts outlive it.
struct gather_scene {
    struct host *host;
    const struct charts *charts;
    struct trace_scene *trace;
    uint32_t *mesh_of; // [instances] in trace->meshes
    uint32_t *first;   // [texel_count + 1] of the texel, in `meeting`
    uint32_t *meeting; // triangles in charts->triangles that meet the texel's square
};
bool gather_scene_init(struct gather_scene *scene, struct host *host, const struct scene_pose *pose,
                       const struct charts *charts);
void gather_scene_finish(struct gather_scene *scene);

// One side of a texel: charts of double-sided materials have two.
struct gather_texel {
    uint32_t texel; // in charts->texels
    bool back;
};

enum { GATHER_POINTS = 16 };
struct gather_point {
    uint32_t triangle; // in charts->triangles
    float u, v;        // barycentric weights of its second and third corner
};
struct gather_points {
    struct gather_point at[GATHER_POINTS]; // in random order
    int count;                             // 0: all are inside of something
};

// ---- points.c

bool gather_list_triangles(struct gather_scene *scene);
void gather_find_points(const struct gather_scene *scene, struct gather_texel texel,
                        struct gather_points *out);
// The trace scene's surface at a point: white, diffuse, without normal map.
struct surface gather_surface(const struct gather_scene *scene, const struct gather_point *point,
                              bool back);

// ---- gather.c. Lux, along the interpolated vertex normal.

// Of punctual lights: the mean over the points.
vec3s gather_punctual(const struct gather_scene *scene, const struct gather_points *points,
                      bool back);
// Of emissive surfaces, the sky and all bounces: the mean of `samples` paths.
vec3s gather_paths(const struct gather_scene *scene, const struct gather_points *points,
                   struct gather_texel texel, int samples, uint64_t seed);
