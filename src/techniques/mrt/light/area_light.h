// Direct light of area lights at the texels and probes of a level: emissive surfaces and the sky,
// for which the frame has no shadow maps. Traced once, with the geometry image.
#pragma once

#include "techniques/common/probes/grid.h"
#include "techniques/mrt/light/ray_cells.h"
#include "techniques/mrt/level/probes.h"

// ---- area_light_points.c: by uniform rays and samples of the emitters

// Direct light of area lights at a probe, world frame.
struct mrt_area_light_probe {
    vec3s emitted[MRT_PROBE_VALUES]; // of emissive surfaces, lux
    float sky[MRT_PROBE_VALUES];     // of a sky of radiance 1/π
    struct mrt_reflector_row reflected;
};

struct mrt_lit_point {
    vec3s position;                    // world
    struct mrt_area_light_probe light; // result, 0 before
    bool solid;                        // result: inside a solid
};

// rays: a power of two. reflectors: which get shares of the points. false: out of memory.
bool mrt_area_light_points(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                           int rays, struct mrt_lit_point *points, size_t count);

// Direct light of area lights at all probes. A probe inside a solid has that of the nearest probe
// of its block outside.
struct mrt_area_light_probe *mrt_area_light_probes_create(const struct trace_scene *scene,
                                                          struct mrt_reflectors *reflectors, int p);

// ---- area_light_outdoors.c: probes outside of all blocks, on a grid over the scene, for surfaces
// that belong to no room

// Values are premultiplied by `open`.
struct mrt_outdoor_probe {
    struct mrt_area_light_probe light;
    // 0: in a block, in a solid or without a view of the sky; 1: outdoors.
    float open;
};

struct mrt_outdoors {
    struct host *host;
    struct frame_probes grid;
    struct mrt_outdoor_probe *probes; // [z][y][x]; NULL: all places are enclosed
};

bool mrt_outdoors_init(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                       struct box3 bounds, struct mrt_outdoors *out);
void mrt_outdoors_finish(struct mrt_outdoors *outdoors); // accepts zero
// About the most that a grid takes on the GPU, with what its probes receive of reflectors.
uint64_t mrt_outdoors_bytes(void);

// ---- area_light.c

struct mrt_scene_images {
    struct host *host;
    struct mrt_geometry_texel *geometry;     // [texels], with light
    struct mrt_area_light_probe *area_light; // [blocks · p³]
    struct mrt_outdoors outdoors;
};

// The reflectors get shares of texels and probes, then their own light. walls: the part of the pose
// that texels stand for; it may be the pose itself. probes: p, along an edge of a block; 0: none.
// kept: the geometry of the same walls, NULL: it is traced.
bool mrt_scene_images_init(struct mrt_reflectors *reflectors, const struct scene_pose *pose,
                           const struct scene_pose *walls, const struct mrt_atlas *atlas,
                           int probes, const struct mrt_geometry_texel *kept,
                           struct mrt_scene_images *out);
// Light at texels. lit: whether there are emitters or sky. reflectors: NULL for their own light.
// false: out of memory.
bool mrt_area_light_texels(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                           const struct mrt_texel_list *texels, bool *lit);
void mrt_scene_images_finish(struct mrt_scene_images *images); // accepts zero
