// Light of emissive surfaces at the texels of a light map: a sum of columns of the bake, weighted
// by the emission of the materials, in the table of texels.
#pragma once

#include "scene/emission_basis.h"

#include "techniques/common/light_map/table.h"

struct tensors;
struct gpu_objects;

struct light_map_emission {
    // [column][texel] irradiance and vector irradiance; [column / 4][texel] fluence of four columns
    gpu_image columns;
    gpu_pipeline sum;      // emission.comp
    gpu_pipeline set_rows; // rows.comp
    uint32_t count, texels;
    bool has_fluence;
    vec4s weights[EMISSION_COLUMNS]; // by colour, cd/m²
    bool pending;                    // the table has not the sum of these weights
};

// The tensor LIGHT_MAP_EMISSION of a bake, which is untrusted. false: host_fail has the reason.
// fluence: with LIGHT_MAP_EMISSION_FLUENCE.
bool light_map_emission_upload(struct light_map_emission *out, struct host *host, struct gpu *gpu,
                               const struct emission_basis *basis, uint32_t texels,
                               const struct tensors *bake, bool fluence);
// Objects for the table of the technique; `at`: offset of the struct in the state.
void light_map_emission_list(size_t at, struct gpu_objects *out);
void light_map_emission_set(struct light_map_emission *emission, const struct emission_basis *basis,
                            const struct scene *scene);
// Before the passes of a frame that read the table. Whether its light has changed.
bool light_map_emission_record(struct light_map_emission *emission, struct gpu_cmd *cmd,
                               gpu_image texels);

// Replaces entries of a table of RGBA32F from `first` on by those of the host.
void light_map_record_rows(const struct light_map_emission *emission, struct gpu_cmd *cmd,
                           gpu_image table, uint32_t first, const vec4s *rows, uint32_t count);
