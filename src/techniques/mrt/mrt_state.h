// The private state of modular radiance transfer.
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"
#include "techniques/common/kept.h"
#include "techniques/mrt/objects/clutter.h"
#include "techniques/mrt/objects/delta_cache.h"
#include "techniques/mrt/level/solver.h"
#include "techniques/mrt/light/reflectors.h"
#include "techniques/mrt/mrt_host_solver.h"
#include "techniques/mrt/mrt_update.h"
#include "techniques/mrt/gpu/runtime.h"
#include "techniques/technique.h"

enum mrt_map_choice { MRT_MAP_SCENE, MRT_MAP_AUTO, MRT_MAP_SINGLE };
enum mrt_warp_choice { MRT_WARP_STRETCH, MRT_WARP_RETRACE, MRT_WARP_AUTO };
enum mrt_solver_choice { MRT_SOLVER_GPU, MRT_SOLVER_CPU };
enum mrt_precision { MRT_PRECISION_HALF, MRT_PRECISION_FLOAT };

enum mrt_update_choice { MRT_UPDATE_BACKGROUND, MRT_UPDATE_WAIT };

enum mrt_clutter_light { MRT_CLUTTER_WALLS, MRT_CLUTTER_PROBES };

struct mrt_options {
#define OPTION OPTION_FIELD
#include "techniques/mrt/mrt_options.def"
#include "techniques/mrt/drt_options.def" // 0 in mrt
#undef OPTION
};

// Data that depend on a pose of the scene, on the blocks of the map. The struct must not move.
struct mrt_parts {
    struct host *host;
    struct mrt_clutter clutter; // drt; until the operators are made, as its texels
    struct mrt_geometry_texel *clutter_texels;
    struct mrt_reflectors reflectors; // until the operators are made
    struct mrt_scene_images images;
    struct hash128 walls; // of the surfaces that images.geometry was traced from
    bool *has_walls;      // [instance_count]: of instances, surfaces that are no clutter
    int instance_count;
};

struct mrt {
    struct mrt_options options;
    struct host *host;
    struct gpu *gpu;
    bool delta;              // drt
    bool leaves_out_clutter; // its operators exceed the device's buffers: all surfaces are walls
    const struct scene_pose *pose; // from `create` to the end of `load`
    // The level.
    struct mrt_block_map map; // no blocks: an empty scene
    struct mrt_atlas atlas;
    struct mrt_parts parts;
    struct mrt_published published; // with `probes`
    gpu_image probe_depth;
    struct mrt_update update;
    uint64_t materials; // revision of the scene's at the start
    // The dictionary and data that depend on both.
    struct mrt_dictionary dictionary;
    struct mrt_level level;
    struct mrt_runtime runtime;
    struct mrt_pixel_lists lists[FRAME_MAX_VIEWS];
    struct mrt_host_solver host_solver; // MRT_SOLVER_CPU
    bool lit;                           // the irradiance of the last frame is valid
    struct kept kept;
};

// ---- mrt_level.c

// Replaces maze=auto by the dictionary that the blocks of the scene need. options: mrt_options.
bool mrt_resolve_maze(struct host *host, const struct scene_pose *pose, void *options);
// The blocks that these options choose for the scene, delta: for drt, as JSON, owned by the caller;
// NULL: host_fail has the reason.
char *mrt_map_json(struct host *host, const struct mrt_options *options, bool delta,
                   const struct scene_pose *pose);
// Blocks, light map and geometry image of the scene; resolves maze=auto.
bool mrt_make_map(struct mrt *mrt, const struct scene_pose *pose);
struct mrt_runtime_options mrt_runtime_options_of(const struct mrt_options *options);
// Operators of the level, from the dictionary, on the GPU. Uses mrt->pose.
bool mrt_make_level(struct mrt *mrt);

// Those of another pose. last: of the pose before, NULL: none; its geometry serves again where the
// walls are the same. mrt_parts_finish accepts zero.
bool mrt_parts_init(struct mrt_parts *out, struct host *host, const struct mrt *mrt,
                    const struct scene_pose *pose, const struct mrt_parts *last);
void mrt_parts_finish(struct mrt_parts *parts);
// Moves images and walls, of parts without clutter.
void mrt_parts_replace(struct mrt_parts *to, struct mrt_parts *from);
// Frees the inputs of operators. Images and walls stay.
void mrt_parts_end_inputs(struct mrt_parts *parts);

struct mrt_build {
    struct mrt_delta_cache *cache; // drt
    struct mrt_plan *plan;         // NULL: on the GPU
    const atomic_bool *stop;       // as of mrt_delta_input
};
bool mrt_make_runtime(const struct mrt *mrt, struct host *host, const struct mrt_parts *parts,
                      const struct mrt_build *how, struct mrt_runtime *out);
