// The private state of precomputed radiance transfer.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/common/light_map/follow.h"
#include "techniques/common/light_map/materials.h"
#include "techniques/common/light_map/map.h"
#include "techniques/common/light_map/texels.h"
#include "techniques/prt/probes/probes.h"
#include "techniques/prt/project.h"
#include "techniques/prt/prt_tensors.h"
#include "techniques/prt/prt_vertex_map.h"

// Transfer vectors, or matrices, of which each row is one: row out · R + r of r of R.
struct prt_tables {
    gpu_image transfer;          // of texels, or of the rows of a codebook
    gpu_image clusters, weights; // of compressed texels
    gpu_image row_light;         // of the newest light, of each row of the codebook
};

struct prt {
    struct prt_options options;
    struct host *host;
    struct gpu *gpu;
    struct charts charts;             // of the receivers
    struct prt_receivers receivers;   // none: an empty scene
    struct light_map light_map;       // shows texels
    struct prt_vertex_map vertex_map; // shows vertices
    struct prt_probes probes;
    struct {
        gpu_image texels;           // of the bake, or vertices
        gpu_image texel_light;      // of the newest light
        gpu_image texel_radiance;   // that texels reflect towards the newest view, with `glossy`
        struct prt_tables vectors;  // of diffuse transfer
        struct prt_tables matrices; // of glossy transfer
    } tables;
    struct {
        gpu_pipeline rows, light, reflect;
    } pipelines;
    struct prt_light light; // the newest
    struct light_map_followed followed;
    struct light_map_materials materials;
    struct kept kept;
    bool warned_lights;
};

// Entries of a row in the table of transfer vectors.
static inline uint32_t prt_row_entries(const struct prt_options *options)
{
    return (prt_dimension(options) + PRT_VECTOR_HALVES - 1) / PRT_VECTOR_HALVES;
}
// Entries of a texel in the table of weights.
static inline uint32_t prt_weight_entries(const struct prt_options *options)
{
    return (prt_vectors(options) + PRT_ROW_HALVES - 1) / PRT_ROW_HALVES;
}

// Address of number k of row `row` of `rows`, in a table with this number of halves in an entry.
static inline uint16_t *prt_table_half(uint16_t *table, size_t halves, size_t rows, size_t row,
                                       size_t k)
{
    return &table[halves * (k / halves * rows + row) + k % halves];
}
// Reflections by matrices.
static inline bool prt_is_glossy(const struct prt_options *options)
{
    return options->glossy && options->specular;
}

// ---- prt_upload.c

// Tables of the receivers and of a bake, which is untrusted, on the GPU.
bool prt_upload(struct prt *state, const struct tensors *bake);

// ---- prt_record.c

// The light of receivers under the newest light and emissive surfaces.
void prt_record_update(struct prt *state, struct gpu_cmd *cmd, const struct frame_view *view);
// The probes under the same, unless they have it.
void prt_record_probes(struct prt *state, struct gpu_cmd *cmd, const struct frame_view *view);
// The radiance that texels reflect towards a view, by the newest light.
void prt_record_reflect(struct prt *state, struct gpu_cmd *cmd, const struct frame_view *view);
