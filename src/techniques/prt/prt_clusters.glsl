// Irradiance by weights of a cluster's mean and vectors, which are lit as vectors are: E = E_0 +
// Σ w_k E_k (Sloan, Hall, Hart & Snyder 2003; Hong 2015, section 2.5.1.5).
#ifndef AG_PRT_CLUSTERS_GLSL
#define AG_PRT_CLUSTERS_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = PRT_VECTORS) const uint VECTORS = 8;

layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D prt_clusters; // [texel]
layout(set = 0, binding = 1, rg32ui) uniform readonly uimage2D prt_weights; // [entry][texel]
layout(set = 0, binding = 4,
       rgba32f) uniform readonly image2D prt_row_light; // [cluster][1 + vector]

vec3 prt_cluster_irradiance(uint texel, uint texels)
{
    uint row = imageLoad(prt_clusters, light_map_at(texel)).x * (1u + VECTORS);
    vec3 sum = imageLoad(prt_row_light, light_map_at(row)).rgb;
    for (uint k = 0; k < VECTORS; k += PRT_ROW_HALVES) {
        vec4 w = light_map_unpack(
            imageLoad(prt_weights, light_map_at(k / PRT_ROW_HALVES * texels + texel)).xy);
        for (uint j = 0; j < min(PRT_ROW_HALVES, VECTORS - k); j++)
            sum += w[j] * imageLoad(prt_row_light, light_map_at(row + 1u + k + j)).rgb;
    }
    return sum;
}

#endif
