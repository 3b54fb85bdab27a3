// The private state of modular radiance transfer.
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"
#include "techniques/mrt/clutter/clutter_light.h"
#include "techniques/mrt/level/solver.h"
#include "techniques/mrt/mrt_host_solver.h"
#include "techniques/mrt/runtime/runtime.h"
#include "techniques/technique.h"

enum mrt_map_choice { MRT_MAP_SCENE, MRT_MAP_AUTO, MRT_MAP_SINGLE };
enum mrt_warp_choice { MRT_WARP_STRETCH, MRT_WARP_RETRACE };
enum mrt_solver_choice { MRT_SOLVER_GPU, MRT_SOLVER_CPU };
enum mrt_precision { MRT_PRECISION_HALF, MRT_PRECISION_FLOAT };

enum mrt_clutter_light { MRT_CLUTTER_WALLS, MRT_CLUTTER_PROBES };

struct mrt_options {
#define OPTION OPTION_FIELD
#include "techniques/mrt/mrt_options.def"
#include "techniques/mrt/drt_options.def" // 0 in mrt
#undef OPTION
};

struct mrt {
    struct host *host;
    struct gpu *gpu;
    struct mrt_options options;
    bool delta; // drt
    // The level.
    struct mrt_block_map map; // no blocks: an empty scene
    struct mrt_atlas atlas;
    struct mrt_scene_images images;
    struct mrt_clutter clutter; // drt
    struct mrt_clutter_texel *clutter_texels;
    // The dictionary and what follows from both.
    struct mrt_dictionary dictionary;
    struct mrt_level level;
    struct mrt_runtime runtime;
    struct mrt_host_solver host_solver; // MRT_SOLVER_CPU
    bool lit;                           // the irradiance of the last frame is valid
    // What the light of the newest frame was computed from; kept: this frame's is the same.
    struct mrt_inputs {
        bool valid;
        uint64_t index, since; // since: the first frame with this light
        uint64_t light;        // hash
    } inputs;
    bool kept;
};

// ---- mrt_level.c

// Replaces maze=auto by the dictionary that the blocks of the scene need.
bool mrt_resolve_maze(struct host *host, const struct scene_pose *pose,
                      struct mrt_options *options);
// Blocks, light map and geometry image of the scene; resolves maze=auto.
bool mrt_make_map(struct mrt *mrt, const struct scene_pose *pose);
struct mrt_runtime_options mrt_runtime_options_of(const struct mrt_options *options);
// Operators of the level, from the dictionary, on the GPU.
bool mrt_make_level(struct mrt *mrt);
