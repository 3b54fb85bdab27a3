// Probes at run time: what moves has their light, and they may be published.
#pragma once

#include "techniques/radiosity/probes/grid.h"
#include "techniques/technique.h"

struct radiosity_probes {
    struct probe_volume volume;
    uint32_t count, entries;   // entries: of a row
    gpu_buffer table, factors; // of probes
    gpu_pipeline gather, apply;
    gpu_sampler linear;
    bool fresh; // the volume has the light of the newest update
};

struct radiosity_probes_create {
    struct host *host;
    struct gpu *gpu;
    const struct radiosity_map *map;
    const struct radiosity_options *options;
};
// bake: untrusted. radiosity_probes_finish accepts zero and half-built.
bool radiosity_probes_init(struct radiosity_probes *out, const struct radiosity_probes_create *how,
                           const struct tensors *bake);
void radiosity_probes_finish(struct radiosity_probes *probes, struct gpu *gpu);

// The light of these clusters and nodes, and of what is not in them.
void radiosity_probes_record_gather(struct radiosity_probes *probes, struct gpu_cmd *cmd,
                                    const struct frame_view *view, gpu_image radiosity,
                                    bool emitters);

// Pixels that the light map has not lit; mapped false: all.
void radiosity_probes_record_apply(const struct radiosity_probes *probes, struct gpu_cmd *cmd,
                                   const struct frame_view *view, bool mapped);

// Of GPU memory.
uint64_t radiosity_probes_memory(const struct radiosity_options *options);
