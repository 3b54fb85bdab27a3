// Reflectance of texels and clusters, which follows the factors of materials: what of it a bake has
// is kept on the host.
#pragma once

#include "trace/texels/texels.h"

#include "techniques/radiosity/radiosity_map.h"

struct radiosity_reflectance {
    struct host *host;
    const struct radiosity_map *map; // with the parts of the bake
    size_t sources;                  // of a row of clusters
    struct texel_factors *factors;   // [texels]
    const int *material_of;          // [instances]
    float *area;                     // [texels] outside geometry, m²
    uint32_t *words;                 // [clusters][sources] node and form factor, as on the GPU
    vec4s *texels;                   // [texels] reflectance; w: mean cosine of shading normals
    vec4s *clusters;                 // [clusters] mean reflectance; w: area, m²
    float *power[2];                 // [nodes]
    float spectral_radius;           // of ρ F, at least
};

// The content of a bake, whose sources and factors have been checked.
struct radiosity_reflectance_input {
    const struct texel_factors *factors; // [texels]
    const float *point;                  // [texels][4]
    const uint32_t *cluster_source;      // [clusters][sources]
    const uint16_t *cluster_factor;
    size_t sources;
};
// radiosity_reflectance_finish accepts zero and a half-built struct.
bool radiosity_reflectance_init(struct radiosity_reflectance *out, struct host *host,
                                const struct radiosity_map *map, const int *material_of,
                                const struct radiosity_reflectance_input *from);
void radiosity_reflectance_finish(struct radiosity_reflectance *reflectance);
// With these materials. Allocates nothing.
void radiosity_reflectance_update(struct radiosity_reflectance *reflectance,
                                  const struct material *materials);
