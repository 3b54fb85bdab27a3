// Probes at run time: they light moving objects, and may be published.
#pragma once

#include "techniques/common/probes/apply.h"
#include "techniques/common/probes/grid.h"
#include "techniques/prt/prt_options.h"

struct tensors;
struct prt_light;

struct prt_probes {
    struct probe_volume volume;
    uint32_t count, rows; // rows: of a probe's matrix
    gpu_image matrices;   // as the table of transfer vectors
    gpu_image table;      // of probes
    gpu_pipeline gather;
    struct probe_apply apply;
    bool fresh; // the volume has the newest light
};

// The tables of a bake, which is untrusted. bounds: of the receivers.
bool prt_probes_upload(struct prt_probes *probes, struct host *host, struct gpu *gpu,
                       struct box3 bounds, const struct prt_options *options,
                       const struct tensors *bake);
// Adds the objects at this offset of the state. consts: of the pipeline.
void prt_probes_list(const struct prt_probes *probes, size_t base,
                     const struct prt_options *options, uint32_t consts, struct gpu_objects *out);
// The volume under the newest light, unless it is fresh. emitters: factor of emissive surfaces.
void prt_probes_record_gather(struct prt_probes *probes, struct gpu_cmd *cmd,
                              const struct prt_light *light, float emitters);
