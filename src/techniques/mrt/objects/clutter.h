// Clutter: parts of a scene inside blocks that no wall of a block represents (Loos 2015, section
// 5.1). A connected part of a mesh is clutter if more than half of its area is in blocks and on no
// wall, by the distances and cosines that separate pixels of walls from others (light_map.glsl).
//
// Nodes can be named as clutter or as walls instead (docs/block-maps.md).
//
// Its triangles have charts (scene/charts), small ones joined. Their parts in each block, of
// double-sided materials each side, are merged into at most `max_faces` faces of that block. A face
// has one radiosity, the constant basis of section 5.3.2.
#pragma once

#include "scene/charts/charts.h"
#include "trace/trace.h"

#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/geometry.h"

// A scene with some of the triangles of another. Vertices, materials and nodes are shared.
struct mrt_part {
    struct scene scene;
    struct scene_pose pose;
};

struct mrt_clutter_face {
    int block;
    uint32_t first_texel, texel_count; // in mrt_clutter.texels
};

// The face that a side of a chart is part of in a block.
struct mrt_chart_face {
    int block, face;
};

struct mrt_clutter {
    struct host *host;
    size_t triangles; // of the clutter; 0: there is none, and the rest is empty
    bool is_too_fine; // its charts have too many texels for a light map: probes light it
    struct mrt_part walls, objects;
    uint32_t *indices;              // of both
    struct charts charts;           // of `objects`
    struct mrt_clutter_face *faces; // in the order of their blocks
    int face_count;
    uint32_t *texels;                   // of both sides, face after face
    struct mrt_chart_face *chart_faces; // side after side of the charts: front, back
    int *face_of_texel;                 // [charts.side_texel_count]
    uint32_t *first_chart_face;         // [mrt_chart_sides + 1]
    uint32_t *scene_triangle_0;         // [instances + 1] of the scene, in scene_chart_triangle
    uint32_t *scene_chart_triangle; // [triangles of the scene] in charts.triangles; CHART_NONE: of
                                    // a wall, or without area
};

struct mrt_clutter_options {
    float texels_per_edge; // of a mean block
    int max_faces;         // in a block
};

// The pose outlives the clutter. mrt_clutter_finish accepts zero.
bool mrt_clutter_init(struct mrt_clutter *out, struct host *host, const struct scene_pose *pose,
                      const struct mrt_block_map *map, const struct mrt_clutter_options *options);
void mrt_clutter_finish(struct mrt_clutter *clutter);

static inline bool mrt_is_clutter(const struct mrt_clutter *clutter, int instance,
                                  uint32_t triangle)
{
    return clutter->triangles > 0 &&
           clutter->scene_chart_triangle[clutter->scene_triangle_0[instance] + triangle] !=
               CHART_NONE;
}

// ---- clutter_find.c

// Writes whether each triangle of the scene, instance after instance, is clutter. Returns their
// number. False without memory.
bool mrt_find_clutter(struct host *host, const struct scene_pose *pose,
                      const struct mrt_block_map *map, bool *is_clutter, size_t *count);
// The block that contains the point, −1: none.
int mrt_block_of_point(const struct mrt_block_map *map, vec3s world, vec3s *cell);

// ---- clutter_named.c

enum mrt_named { MRT_NAMED_NOT, MRT_NAMED_CLUTTER, MRT_NAMED_WALL };
// An mrt_named of each node of the scene, by the names of the map and the extras of nodes; a node
// without has that of its parent. The caller frees it. NULL: FAIL_FORMAT where the scene lacks a
// node of the map, or without memory.
unsigned char *mrt_named_nodes(struct host *host, const struct scene *scene,
                               const struct mrt_block_map *map);

// ---- clutter_open.c

// Connects blocks whose common wall is clutter alone. vertical: floors and ceilings too. Writes
// whether there were any: the clutter is then that of another map.
bool mrt_open_clutter_walls(struct mrt_block_map *map, const struct mrt_clutter *clutter,
                            bool vertical, bool *any);

// ---- clutter_faces.c

// Whether the hit of `objects` is the back of a single-sided surface, which is met inside a solid.
bool mrt_is_inside_at(const struct mrt_clutter *clutter, const struct trace_hit *hit);
// The face of a block at a hit of `objects`; −1: none, as of a triangle without area.
int mrt_face_of_hit(const struct mrt_clutter *clutter, int block, const struct trace_hit *hit);
// The face of any block, by the texel that is hit.
int mrt_face_at(const struct mrt_clutter *clutter, const struct trace_hit *hit);
// back: of a chart that has one.
int mrt_face_of_chart(const struct mrt_clutter *clutter, int block, uint32_t chart, bool back);
size_t mrt_chart_sides(const struct mrt_clutter *clutter);
bool mrt_make_clutter_faces(struct mrt_clutter *clutter, const struct mrt_block_map *map,
                            int max_faces);

// ---- clutter_light.c

struct mrt_reflectors;
// Points of clutter where a frame computes direct light, and their light of emitters, the sky and
// reflectors: one for each of clutter->texels, in their order. The caller frees it with host_free;
// NULL without memory.
struct mrt_geometry_texel *mrt_clutter_light_create(struct host *host,
                                                    const struct scene_pose *pose,
                                                    const struct mrt_clutter *clutter,
                                                    struct mrt_reflectors *reflectors);
