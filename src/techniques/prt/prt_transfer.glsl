// Irradiance by rows of transfer vectors: E = Σ T_i L_i.
#ifndef AG_PRT_TRANSFER_GLSL
#define AG_PRT_TRANSFER_GLSL

#include "core/sh.glsl"
#include "techniques/common/light_map/table.glsl"
#include "techniques/prt/prt_shared.h"

layout(constant_id = PRT_COEFFICIENTS) const uint COEFFICIENTS = 9;
layout(constant_id = PRT_BOUNCES) const bool BOUNCES = true;

layout(set = 0, binding = 0, scalar) uniform prt_light_block
{
    prt_light light;
};
layout(set = 0, binding = 1, rg32ui) uniform readonly uimage2D prt_transfer; // [entry][row]

vec3 prt_row_irradiance(uint row, uint rows)
{
    vec3 sum = vec3(0.0);
    if (BOUNCES) {
        for (uint k = 0; k < COEFFICIENTS; k++) {
            vec4 t = light_map_unpack(imageLoad(prt_transfer, light_map_at(k * rows + row)).xy);
            sum += t.x * light.direct[k].rgb + t.yzw * light.bounced[k].rgb;
        }
    } else {
        // Coefficients beyond the last are 0, as is their light.
        for (uint k = 0; k < COEFFICIENTS; k += PRT_ROW_HALVES) {
            vec4 t = light_map_unpack(
                imageLoad(prt_transfer, light_map_at(k / PRT_ROW_HALVES * rows + row)).xy);
            for (uint j = 0; j < min(PRT_ROW_HALVES, COEFFICIENTS - k); j++)
                sum += t[j] * light.direct[k + j].rgb;
        }
    }
    return sum;
}

// Of the visible part of a sky of radiance 1, without bounces.
float prt_row_sky(uint row)
{
    return light_map_unpack(imageLoad(prt_transfer, light_map_at(row)).xy).x / SH_Y0;
}

#endif
