// The private state of precomputed radiance transfer.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/common/light_map/follow.h"
#include "techniques/common/light_map/map.h"
#include "techniques/common/light_map/texels.h"
#include "techniques/prt/project.h"
#include "techniques/prt/prt_tensors.h"

struct prt {
    struct prt_options options;
    struct host *host;
    struct gpu *gpu;
    struct charts charts; // without texels: an empty scene
    struct light_map light_map;
    struct {
        gpu_image texels, transfer;  // of the bake; the latter of texels or clusters
        gpu_image clusters, weights; // of compressed texels
        gpu_image row_light;         // of the newest light, of each row of the codebook
        gpu_image texel_light;       // and of texels
    } tables;
    struct {
        gpu_pipeline rows, light;
    } pipelines;
    struct light_map_followed followed;
    struct kept kept;
    bool said_lights;
};

// Entries of a row in the table of transfer vectors.
static inline uint32_t prt_row_entries(const struct prt_options *options)
{
    return (prt_dimension(options) + PRT_ROW_HALVES - 1) / PRT_ROW_HALVES;
}
// Entries of a texel in the table of weights.
static inline uint32_t prt_weight_entries(const struct prt_options *options)
{
    return (prt_vectors(options) + PRT_ROW_HALVES - 1) / PRT_ROW_HALVES;
}

// ---- prt_upload.c

// Tables of the light map and of a bake, which is untrusted, on the GPU.
bool prt_upload(struct prt *state, const struct tensors *bake);

// ---- prt_record.c

// The light map under distant light and emissive surfaces.
void prt_record_update(struct prt *state, struct gpu_cmd *cmd, const struct frame_view *view,
                       const struct prt_light *light);
