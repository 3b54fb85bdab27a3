// Low-rank transfer at run time: the modes of each region from the radiosities of its sources, then
// the light of its texels from the modes.
#pragma once

#include "gpu/gpu.h"

#include "techniques/radiosity/lowrank/regions.h"
#include "techniques/technique.h"

struct radiosity_lowrank {
    uint32_t regions;               // 0: transfer is sparse
    float mean_entries, mean_modes; // of a region: products of a projection; modes
    gpu_image order;                // [row] texel
    gpu_image sources;              // of all regions: nodes
    gpu_image projections, expansions;
    gpu_image scales;        // [mode of all regions]
    gpu_buffer table, modes; // [region] lowrank_shared.h; [mode of all regions]
    gpu_pipeline project, expand;
};

struct radiosity_lowrank_create {
    struct host *host;
    struct gpu *gpu;
    const struct radiosity_map *map;
    const struct radiosity_options *options;
};
// bake: untrusted. radiosity_lowrank_finish accepts zero and half-built.
bool radiosity_lowrank_init(struct radiosity_lowrank *out,
                            const struct radiosity_lowrank_create *how, const struct tensors *bake);
void radiosity_lowrank_finish(struct radiosity_lowrank *lowrank, struct gpu *gpu);

// Of regions first … first + count − 1. radiosity: of clusters and nodes.
void radiosity_lowrank_project(const struct radiosity_lowrank *lowrank, struct gpu_cmd *cmd,
                               uint32_t first, uint32_t count, gpu_image radiosity);
// What rows `first` … receive. texels: their table; light: of all texels.
struct radiosity_lowrank_rows {
    uint32_t first, count;
    gpu_image texels, light;
    uint32_t texel_count;
    bool emitters;
};
void radiosity_lowrank_expand(const struct radiosity_lowrank *lowrank, struct gpu_cmd *cmd,
                              const struct frame_view *view,
                              const struct radiosity_lowrank_rows *rows);

// Of GPU memory.
uint64_t radiosity_lowrank_memory(const struct radiosity_options *options, uint64_t texels);
