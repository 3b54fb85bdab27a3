// The private state of radiosity.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/radiosity/probes/probes.h"
#include "techniques/common/light_map/emission.h"
#include "techniques/common/light_map/materials.h"
#include "techniques/common/light_map/map.h"
#include "techniques/common/light_map/texels.h"
#include "techniques/common/light_map/follow.h"
#include "techniques/common/light_map/paint.h"
#include "techniques/radiosity/radiosity_reflectance.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_strata.h"
#include "techniques/radiosity/radiosity_tensors.h"

// Tiles of rows of form factors in one table: all may be more than a table has.
struct radiosity_block {
    gpu_image table;
    uint32_t first, count; // rows
};

// Rows of texels, strata or clusters that are near to each other, by decreasing number of entries:
// few entries of a tile are zeros.
struct radiosity_rows {
    struct radiosity_block *blocks;
    uint32_t count;         // of blocks
    float mean_entries;     // of a row
    gpu_image order, tiles; // [row] texel and its block's first stratum, stratum or cluster;
                            // [tile] first texel in its block, of a row
};

struct radiosity_tables {
    gpu_image texels, sky, neighbours;          // of texels
    gpu_image clusters, spans, members, groups; // of clusters
    gpu_image flux, light, smoothed;            // [texels] of the newest light
    gpu_image fluence, smoothed_fluence;        // [texels] of it by colour
    gpu_image sent, radiosity[2];               // [clusters and nodes] likewise
    gpu_image solution;                         // [clusters and nodes] of all bounces
    gpu_image strata;                           // [strata of blocks] of the solution
    gpu_buffer labels;                          // of places, for debug views
    // factors: of texels, by strata of their blocks; shares: of strata, by clusters and nodes.
    struct radiosity_rows factors, shares, cluster_factors;
};

struct radiosity_pipelines {
    gpu_pipeline direct, clusters, nodes, solve, strata, gather, smooth, view;
};

// Stages of an update, in their order.
enum radiosity_stage {
    RADIOSITY_DIRECT, // until the radiosity of clusters before any bounce
    RADIOSITY_BOUNCES,
    RADIOSITY_STRATA,
    RADIOSITY_GATHER,
    RADIOSITY_SMOOTH,
    RADIOSITY_SMOOTH_WIDE,
    RADIOSITY_LIGHT_MAP,
    RADIOSITY_SEAMS,
    RADIOSITY_STAGES,
};

// Rows of a stage.
struct radiosity_part {
    enum radiosity_stage stage;
    int step, steps; // of RADIOSITY_BOUNCES
    uint32_t first, count;
};

struct radiosity_update {
    bool running;
    bool changed;             // light is to be computed again since it started
    bool other, brings_other; // light differs since it started; it brings light that differs
    bool at_once;             // to be completed in this frame
    struct radiosity_part at; // the next part
};

struct radiosity {
    struct radiosity_options options;
    struct host *host;
    struct gpu *gpu;
    struct radiosity_map map; // without texels: an empty scene
    struct light_map light_map;
    struct light_map_paint paint;
    uint32_t group_count, stratum_count;
    struct light_map_materials materials;
    struct light_map_emission emission;
    struct radiosity_reflectance reflectance;
    bool reflectance_changed; // the tables have not the newest
    float spectral_radius;    // of the tables' ρ F, at least
    struct radiosity_tables tables;
    struct radiosity_pipelines pipelines;
    struct radiosity_update update;
    struct radiosity_probes probes;
    struct light_map_followed followed;
    struct kept kept;
};

// ---- radiosity_upload.c, radiosity_factors.c, radiosity_neighbours.c, probes/upload.c

// Tables of the light map and of a bake on the GPU.
bool radiosity_upload(struct radiosity *state, const struct tensors *bake);
// Rows of a bake: of texels by strata of their blocks, and of clusters.
struct radiosity_sources {
    const uint16_t *factor; // [texels][sources][3]
    const struct radiosity_strata *strata;
    const uint32_t *cluster_source;
    const uint16_t *cluster_factor; // [clusters][2 · sources]
};
// The form factors of texels and of clusters and the shares of strata, block after block.
bool radiosity_upload_factors(struct radiosity *state, const struct radiosity_sources *from);
void radiosity_destroy_rows(struct radiosity *state, struct radiosity_rows *rows);

// The content of a bake about the surroundings of texels.
struct radiosity_surroundings {
    const struct light_map_texels *texels;
    const float *nearness;         // [texels][4] means of direction/distance and 1/distance, 1/m
    const uint32_t *nearest_valid; // [texels]
};
// The neighbours over which light is smoothed. sky: [texels][4], becomes that of the texels,
// smoothed.
bool radiosity_upload_neighbours(struct radiosity *state,
                                 const struct radiosity_surroundings *surroundings, float *sky);

// The grid of probes, and its tables. After radiosity_upload.
bool radiosity_probes_upload(struct radiosity *state, const struct tensors *bake);

// ---- radiosity_update.c

// This frame's share of the light that `update` asks for.
void radiosity_record_update(struct radiosity *state, struct gpu_cmd *cmd,
                             const struct frame_view *view);

// ---- radiosity_follow.c

// Takes over the materials of the scene.
void radiosity_follow_materials(struct radiosity *state, const struct scene *scene);
// Whether the tables have not the newest materials.
bool radiosity_has_new_materials(const struct radiosity *state);
// Before the passes of a frame, not between those of an update: brings the tables up to date.
void radiosity_record_materials(struct radiosity *state, struct gpu_cmd *cmd);

// ---- radiosity_record.c

uint32_t radiosity_stage_rows(const struct radiosity *state, enum radiosity_stage stage);
const char *radiosity_stage_name(enum radiosity_stage stage);
// Records the rows of a part, and with the last ones the passes that follow the stage or the step.
void radiosity_record_part(struct radiosity *state, struct gpu_cmd *cmd,
                           const struct frame_view *view, const struct radiosity_part *part);

// ---- radiosity_view.c

extern const struct technique_debug_view radiosity_views[];
// points: [texels] position (m), share, of a bake.
bool radiosity_view_init(struct radiosity *state, const float *points,
                         const uint32_t *nearest_valid);
void radiosity_view_record(struct radiosity *state, struct gpu_cmd *cmd,
                           const struct frame_view *view, const char *name, gpu_image out);
