// Probes at run time: what moves has their light, and they may be published.
#pragma once

#include "techniques/common/probes/apply.h"
#include "techniques/radiosity/probes/grid.h"
#include "techniques/technique.h"

struct radiosity_probes {
    struct probe_volume volume;
    uint32_t count, entries;   // entries: of a row
    gpu_buffer table, factors; // of probes
    gpu_pipeline gather;
    struct probe_apply apply;
    bool fresh; // the volume has the light of the newest update
};

// The light of these clusters and nodes, and of what is not in them.
void radiosity_probes_record_gather(struct radiosity_probes *probes, struct gpu_cmd *cmd,
                                    const struct frame_view *view, gpu_image radiosity,
                                    bool emitters);
