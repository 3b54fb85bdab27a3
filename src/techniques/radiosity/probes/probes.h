// Probes at run time: they light moving objects, and may be published.
#pragma once

#include "techniques/common/light_map/emission.h"
#include "techniques/common/probes/apply.h"
#include "techniques/radiosity/probes/grid.h"
#include "techniques/technique.h"

struct radiosity_probes {
    struct probe_volume volume;
    uint32_t count, entries;   // entries: of a row
    gpu_buffer table, factors; // of probes
    gpu_buffer emission;       // [column][probe]
    gpu_pipeline gather;
    struct probe_apply apply;
    bool fresh; // the volume has the light of the newest update
};

// Gathers the light of clusters and nodes, the sky and emitters; emission: of their weights, NULL:
// they are no sources.
void radiosity_probes_record_gather(struct radiosity_probes *probes, struct gpu_cmd *cmd,
                                    const struct frame_view *view, gpu_image radiosity,
                                    const struct light_map_emission *emission);
