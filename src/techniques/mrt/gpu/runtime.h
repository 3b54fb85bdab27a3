// The run time of modular radiance transfer on the GPU (Loos 2015, section 3.6.3): operators and
// tables of a level in buffers, and the passes of a frame.
#pragma once

#include "frame/frame.h"

#include "techniques/common/light_map/columns.h"
#include "techniques/common/light_map/surface.h"
#include "techniques/mrt/objects/clutter.h"
#include "techniques/mrt/light/area_light.h"
#include "techniques/mrt/level/operators.h"
#include "techniques/mrt/level/published.h"
#include "techniques/mrt/mrt_shared.h"

// A level: its blocks, its light map, its geometry image and its operators.
struct mrt_runtime_input {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    const struct mrt_scene_images *images;
    const struct mrt_reflectors *reflectors; // NULL: none
    const struct mrt_operators *operators;
    const struct mrt_published *published; // NULL: none
    // Clutter of the openings that are clutter; NULL where there are none.
    const struct mrt_clutter *clutter;
    const struct mrt_geometry_texel *clutter_texels; // those of clutter->texels, in their order
};

struct mrt_runtime_options {
    bool half;     // operators are half floats, else floats
    bool vector;   // irradiance by normal
    bool probes;   // there are volume probes
    bool clutter;  // they light surfaces inside blocks, else the walls that face these do
    bool publish;  // their volume
    bool specular; // pixels get what the specular lobe reflects
};

struct mrt_runtime_pipelines {
    gpu_pipeline reflectors, reflectors_bounce, direct, project, bounce, couple;
    gpu_pipeline bright, bright_light; // of affine cubes
    gpu_pipeline reconstruct, reconstruct_vector;
    gpu_pipeline fill;
    gpu_pipeline rows, apply, debug;
    gpu_pipeline apply_clutter;          // `apply`, where there is clutter
    gpu_pipeline clutter, amid, several; // of their lists
};

// Volume probes; without them `bricks` is 1×1×1.
struct mrt_runtime_probes {
    gpu_image bricks;
    gpu_pipeline fill;
    struct frame_probes grid; // published
    gpu_image volume;
    gpu_pipeline publish;
};

// Without outdoor places `image` is 1×1×FRAME_PROBE_SLABS, and the pipeline is none.
struct mrt_runtime_outdoors {
    gpu_image image;
    gpu_pipeline fill;
};

// The light map of clutter; without one tile_count is 0 and the others are empty.
struct mrt_runtime_clutter_map {
    struct light_map_surfaces surfaces;
    gpu_image image;
    gpu_pipeline fill;
    uint32_t tile_count;
    bool is_clear;                          // the others, of the image
    struct mrt_clutter_fill_push fill_push; // of the newest direct light
};

// Without clutter all counts are 0 and the others are empty.
struct mrt_runtime_clutter {
    // Buffers of radiosity that is reflected of the newest bounce, [newest], and of the one before:
    // [clutter][colour][slot].
    int reflected[2], newest;
    gpu_pipeline light, couple;
    uint32_t group_count, opening_count;
    struct mrt_runtime_clutter_map map;
};

struct mrt_plan;

enum { MRT_MAX_BUFFERS = 64 };

struct mrt_runtime {
    struct host *host;
    struct gpu *gpu;
    struct mrt_plan *plan; // while it is planned, else NULL
    struct mrt_runtime_options options;
    struct mrt_level_params level;
    uint32_t block_count, opening_count;
    // 1 + ρ + ρ² + …, of the mean reflectance ρ of all walls in the colour where it is largest.
    float rest;
    // Tables, operators and light of the level, by the names of their bindings (mrt_buffer).
    gpu_buffer buffers[MRT_MAX_BUFFERS];
    const char *buffer_names[MRT_MAX_BUFFERS];
    int buffer_count;
    gpu_image light_map;             // LIGHT_MAP_LAYERS, without `vector` one
    gpu_image block_rows, cell_rows; // of rows.glsl
    bool has_rows;                   // they are filled
    struct light_map_columns columns;
    bool has_lists; // `apply` leaves pixels to lists: blocks are affine cubes
    struct mrt_runtime_pipelines pipelines;
    struct mrt_runtime_probes probes;
    struct mrt_runtime_outdoors outdoors;
    struct mrt_runtime_clutter clutter;
    gpu_sampler linear;
    struct gpu_objects objects; // all of these
};

// The input may end with the call, but for map and atlas.
bool mrt_runtime_init(struct mrt_runtime *out, struct host *host, struct gpu *gpu,
                      const struct mrt_runtime_input *input,
                      const struct mrt_runtime_options *options);
// Makes all of the run time but its handles (objects.h), on a thread without a GPU.
bool mrt_runtime_plan(struct mrt_runtime *out, struct mrt_plan *plan,
                      const struct mrt_runtime_input *input,
                      const struct mrt_runtime_options *options);
// A runtime without blocks: a black probe volume, if volumes are published.
bool mrt_runtime_init_empty(struct mrt_runtime *out, struct host *host, struct gpu *gpu,
                            const struct mrt_runtime_options *options);
void mrt_runtime_finish(struct mrt_runtime *runtime); // accepts zero and half-built
// The buffer that shaders read or write by this name; none where the level has none.
gpu_buffer mrt_buffer(const struct mrt_runtime *runtime, const char *name);

struct mrt_runtime_size {
    int resolution, k_b, k_r, probes;
    bool tube, has_clutter;
    struct mrt_runtime_options options;
};
// Bytes on the GPU of a level of one closed cube, or of one tube. Of clutter it has no texels:
// their number is the scene's.
uint64_t mrt_runtime_bytes(const struct mrt_runtime_size *size);

// ---- stages of a frame, in this order (stages.c)

// Radiosity of the texels before any bounce.
void mrt_record_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                       const struct frame_view *view, bool emitters);
// Replaces the first bounce of far brighter texels than the others of their block, of which few
// modes make dark and bright patches. Nothing where blocks are no affine cubes.
void mrt_record_bright(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
// feedback: the weight of the last call's indirect light, which the first bounce reflects too;
// 0: none. rest: that of the last power of the series, 1, or runtime.rest for its remainder, too.
struct mrt_bounces {
    int count;
    float feedback, rest;
};
// Σ Mⁿ f by Horner's scheme: the weight of the light that bounce i of the loop reflects.
static inline float mrt_weight_of_bounce(const struct mrt_bounces *bounces, int i)
{
    return i == 0 ? bounces->feedback : i == 1 ? bounces->rest : 1.0f;
}
// Indirect irradiance of the texels.
void mrt_record_bounces(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                        const struct mrt_bounces *bounces);
// b and r of the radiosity in mrt_radiosity, where the host computed irradiance.
void mrt_record_coefficients(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
// U_b b + U_r r at the texels of some tiles. vector: by normal. Names of buffers.
struct mrt_reconstruct {
    bool vector;
    const char *tiles, *openings, *u_b, *u_r, *irradiance;
    uint32_t texels_of_tile, tile_count;
};
void mrt_record_reconstruct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                            const struct mrt_reconstruct *what);
// The light map with its borders, and irradiance by normal.
void mrt_record_light_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
// Probes of all blocks, and the published volume, from the newest b and r.
void mrt_record_probes(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                       const struct frame_view *view, float gain);
// Outdoor probes, of this frame's sky.
void mrt_record_outdoors(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                         const struct frame_view *view);
// Lists of the pixels of a view (mrt_list_header): those that probes light, those that several
// lookups do, and those of clutter in drt.
struct mrt_pixel_lists {
    gpu_buffer amid, several, clutter;
};
static inline size_t mrt_list_bytes(uint32_t width, uint32_t height)
{
    return sizeof(struct mrt_list_header) + (size_t)width * height * sizeof(uint32_t);
}
// Irradiance of each pixel, and specular light.
void mrt_record_apply(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                      const struct frame_view *view, const struct mrt_pixel_lists *lists,
                      float gain);
void mrt_record_debug(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                      const struct frame_view *view, uint32_t debug_view, gpu_image out);
