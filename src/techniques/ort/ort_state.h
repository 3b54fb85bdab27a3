// The private state of offset radiance transfer maps.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/common/light_map/emission.h"
#include "techniques/common/light_map/follow.h"
#include "techniques/common/light_map/materials.h"
#include "techniques/common/light_map/paint.h"
#include "techniques/common/light_map/map.h"
#include "techniques/common/light_map/texels.h"
#include "techniques/ort/ort_maps.h"
#include "techniques/ort/ort_shared.h"

struct ort_tables {
    gpu_image texels, sky, places;  // of texels
    gpu_image lists, entries, bins; // of the gather
    gpu_image first_order, light;   // of the newest light: by place; in pairs, levels of it
    gpu_image steps, filtered;      // between linked texels; light along rows
    gpu_image sums, texel_light;    // transfer of the maps; light of texels
};

struct ort_pipelines {
    gpu_pipeline direct, spread, prefilter_x, prefilter_y, gather, finish, replace;
};

struct ort {
    struct ort_options options;
    struct host *host;
    struct gpu *gpu;
    struct ort_map map; // without texels: an empty scene
    uint32_t rows;      // of a workgroup of the gather
    uint32_t levels;    // of light that offsets use, at least 1
    struct light_map light_map;
    struct light_map_paint paint;
    struct ort_tables tables;
    struct ort_pipelines pipelines;
    struct light_map_followed followed;
    struct light_map_materials materials;
    struct light_map_emission emission;
    struct kept kept;
};

// Runs in a row of places, and workgroups of the gather in a column of them.
static inline uint32_t ort_columns(const struct ort_map *map)
{
    return (map->width + ORT_RUN - 1) / ORT_RUN;
}
static inline uint32_t ort_blocks(const struct ort *state)
{
    return (state->map.height + state->rows - 1) / state->rows;
}

// ---- ort_upload.c, ort_bins_upload.c, ort_lists.c

// Tables of the light map and of a bake, which is untrusted, on the GPU.
bool ort_upload(struct ort *state, const struct tensors *bake);

struct ort_bins;
// The weights of pieces in bins.
bool ort_upload_bins(struct ort *state, const struct ort_maps *maps, const struct ort_bins *bins);
// For each workgroup of the gather and each part the pieces in it, bin after bin. scale: [maps] of
// bytes.
bool ort_upload_lists(struct ort *state, const struct ort_maps *maps, const struct ort_bins *bins,
                      const float *scale);

// ---- ort_record.c

// The light map under the lights of a frame.
void ort_record_update(struct ort *state, struct gpu_cmd *cmd, const struct frame_view *view);
// From first-order light by place to its levels: a part of the former.
void ort_record_levels(struct ort *state, struct gpu_cmd *cmd);
// A view's pixels.
void ort_record_apply(struct ort *state, struct gpu_cmd *cmd, const struct frame_view *view);
