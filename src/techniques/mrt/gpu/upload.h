// Parts of a run time: its buffers, images and pipelines, and their content from a level. They are
// created at once, or planned on a thread that has no GPU, created later and filled over frames.
#pragma once

#include "techniques/mrt/gpu/runtime.h"

// ---- objects.c

// The object gets a row of runtime->objects; `out` is a member of the run time. With runtime->plan
// it is planned: it is created with the others of the table. `desc`, `name` and `shader` are
// constant.
//
// A storage buffer with this content, for bindings of this name, which begins with mrt_; zeros
// where data is NULL, 16 of them where bytes is 0.
bool mrt_buffer_of(struct mrt_runtime *runtime, const char *name, const void *data, size_t bytes);
// The same of `count` items that `fill` writes; zeros where it is NULL.
bool mrt_table_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                      const char *name, size_t count, size_t size,
                      void (*fill)(const struct mrt_runtime_input *input, void *items));
bool mrt_image_of(struct mrt_runtime *runtime, const struct gpu_image_desc *desc, gpu_image *out);
bool mrt_sampler_of(struct mrt_runtime *runtime, const char *name, gpu_sampler *out);
// Rows of runtime->objects.constants: those of MRT_CONSTANT_…, and these.
enum {
    MRT_CONSTANT_ROW_VECTOR = MRT_CONSTANT_OUTDOORS + 1,
    MRT_CONSTANT_ROW_BACKS,
    MRT_CONSTANT_ROW_COLUMNS, // three: LIGHT_MAP_APPLY_WIDTH, _HEIGHT, _ROWS
};
// constants: bits of these rows.
bool mrt_pipeline_of(struct mrt_runtime *runtime, const char *name, const struct gpu_shader *shader,
                     uint32_t constants, gpu_pipeline *out);

// gpu_dispatch with the parameters and all buffers of the level but for names that `bindings` has.
void mrt_dispatch(const struct mrt_runtime *runtime, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                  const struct gpu_binding *bindings, int binding_count, const void *push,
                  size_t push_bytes, uint32_t groups_x, uint32_t groups_y, uint32_t groups_z);
#define MRT_NO_BINDINGS NULL, 0
// gpu_dispatch_indirect with the same, without push constants.
void mrt_dispatch_indirect(const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                           gpu_pipeline pipeline, const struct gpu_binding *bindings,
                           int binding_count, gpu_buffer arguments, size_t offset);

struct mrt_plan {
    struct host *host;
    struct light_map_columns columns; // of the device
    char *data[GPU_MAX_OBJECTS];      // content of runtime->objects; NULL: zeros
    int item;                         // the next byte that mrt_plan_record copies
    size_t offset;
};

// Copies the next bytes of the content, at most `most`. Returns whether that was the rest.
bool mrt_plan_record(struct mrt_plan *plan, const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                     size_t most);
void mrt_plan_finish(struct mrt_plan *plan); // accepts zero

// ---- sizes

// Rounded up to a multiple of four.
static inline uint32_t mrt_quads(int modes)
{
    return (uint32_t)(modes + 3) / 4;
}
// Tiles of MRT_LOCAL texels of the light map of clutter.
static inline size_t mrt_clutter_map_tiles(size_t texels)
{
    return (texels + MRT_LOCAL - 1) / MRT_LOCAL;
}
enum { MRT_LOOKUP_CELLS = 32 }; // along the longest side of the level

// ---- content. Each function uploads its part into new objects.

// Texels, tiles, blocks, openings, pairs and borders (mrt_shared.h); fills runtime->level but for
// the lookup grid.
bool mrt_tables_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
void mrt_fill_texels(const struct mrt_geometry_texel *from, size_t count, struct mrt_texel *out);
// Quads of an opening's coefficients.
uint32_t mrt_used_quads(const struct mrt_operators *operators, const struct mrt_opening *opening);
// A face of clutter that sends light to an opening.
struct mrt_sender {
    int block, slot;   // of the opening that is its clutter
    const float *of_c; // [k_r]
};
// Those of all openings, one after the other, without faces that send none; the caller frees them.
struct mrt_sender *mrt_all_senders(struct host *host, const struct mrt_operators *operators,
                                   uint32_t *count);
// First texel of a block, those of its walls in ascending order; −1: no wall.
int mrt_first_texel(const struct mrt_atlas *atlas, int block);
// The blocks near each cell of a grid, for locate.glsl.
bool mrt_lookup_grid_upload(struct mrt_runtime *runtime, const struct mrt_block_map *map);
// Volume probes of a level (Loos 2015, section 3.5.5).
bool mrt_probes_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// One dark point to publish.
bool mrt_probes_make_empty(struct mrt_runtime *runtime);
// MRT_CONSTANT_SIGHT.
uint32_t mrt_sight_voxels(const struct mrt_operators *operators);
// Reflectors and the shares of them.
bool mrt_reflectors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// Their light, before all that has shares of it.
void mrt_record_reflectors(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                           const struct frame_view *view);
// The grid of outdoor probes (light/area_light.h).
bool mrt_outdoors_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
// All operators as the shaders read them (operators.glsl): rows of four numbers at a time, half
// floats or floats.
bool mrt_operators_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);

// Scales of b-coefficients on the GPU.
struct mrt_scales {
    float *of_b;    // [basis][k_b]: the stored b over the dictionary's
    float *inverse; // [basis][k_b]
    int k_b;
};
// One bounce within the reduced spaces: b of the light that each block reflects of b and of r.
bool mrt_reflection_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                           const struct mrt_scales *scales);

// Bright texels of blocks.
bool mrt_bright_upload(struct mrt_runtime *runtime, int k_b);
uint64_t mrt_bright_bytes(uint64_t k_b); // of a block; k_b: padded

// Clutter: nothing without openings that are clutter. Direct light of its faces; its light map.
bool mrt_clutter_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
bool mrt_clutter_direct_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);
bool mrt_clutter_map_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input);

// ---- passes of clutter

// Radiosity of direct light of the faces; runtime->level has the parameters of direct light.
void mrt_record_clutter_direct(struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                               const struct frame_view *view);
// Its light map, from the newest b and r.
void mrt_record_clutter_map(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
// T_b→r of each bounce and c, where there is clutter.
void mrt_record_clutter_couple(struct mrt_runtime *runtime, struct gpu_cmd *cmd);
