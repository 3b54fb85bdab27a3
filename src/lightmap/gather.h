// Irradiance of light-map texels by the path tracer. Sample points are spread over the part of a
// texel's square that the surface covers; points inside geometry are left out.
#pragma once

#include "lightmap/noise.h"
#include "trace/path.h"

// gather_scene_finish accepts zero. pose and charts outlive it.
struct gather_scene {
    struct host *host;
    const struct charts *charts;
    struct trace_scene *trace;
    uint32_t *first;   // [texel_count + 1] of the texel, in `meeting`
    uint32_t *meeting; // triangles in charts->triangles that meet the texel's square
};
bool gather_scene_init(struct gather_scene *scene, struct host *host, const struct scene_pose *pose,
                       const struct charts *charts);
void gather_scene_finish(struct gather_scene *scene);

enum { GATHER_POINTS = 16 };
struct gather_point {
    uint32_t triangle; // in charts->triangles
    float u, v;        // barycentric weights of its second and third corner
};
struct gather_points {
    struct gather_point at[GATHER_POINTS]; // in random order
    int count;                             // 0: all are inside geometry
    uint32_t pixel;                        // of random numbers: the front in charts->texels
    bool back;
};

// ---- points.c

bool gather_list_triangles(struct gather_scene *scene);
// texel: of both sides of the charts.
void gather_find_points(const struct gather_scene *scene, uint32_t texel,
                        struct gather_points *out);
// The same where none of its points is inside geometry, without the rays that would tell.
void gather_find_open_points(const struct gather_scene *scene, uint32_t texel,
                             struct gather_points *out);
// The trace scene's surface at a point: white, diffuse, without normal map.
struct surface gather_surface(const struct gather_scene *scene, const struct gather_point *point,
                              bool back);

// ---- gather.c. Lux, along the interpolated vertex normal.

// Irradiance by punctual lights: the mean over the points.
vec3s gather_punctual(const struct gather_scene *scene, const struct gather_points *points);
// Texels next to each other, of one side of a chart, whose paths are shared (trace/share.h).
enum { GATHER_TILE = NOISE_TILE };
struct gather_tile {
    uint32_t first, count; // texels; count 0: none yet
    struct gather_points points[GATHER_TILE];
    vec3s light[GATHER_TILE];    // lux
    float variance[GATHER_TILE]; // of its luminance, lux²
};
// The texels that share paths with this one: the same for each of them.
void gather_tile_of(const struct gather_scene *scene, uint32_t texel, struct gather_tile *out);
static inline bool gather_tile_has(const struct gather_tile *tile, uint32_t texel)
{
    return texel >= tile->first && texel < tile->first + tile->count;
}

// Irradiance by emissive surfaces, the sky and all bounces: means of `samples` paths of each texel.
// variance: from groups of successive paths; somewhat too large, since a group is stratified less
// than all.
void gather_tile_paths(const struct gather_scene *scene, struct gather_tile *tile, int samples,
                       uint64_t seed);
// Adds paths `before` to `after` − 1 of each texel, in groups: multiples of NOISE_GROUPS. sums: of
// the tile's texels.
void gather_grouped_paths(const struct gather_scene *scene, const struct gather_tile *tile,
                          uint32_t before, uint32_t after, uint64_t seed, struct noise_sums *sums);
// The light of one texel, or of a point, by paths that are not shared.
vec3s gather_paths(const struct gather_scene *scene, const struct gather_points *points,
                   int samples, uint64_t seed);
