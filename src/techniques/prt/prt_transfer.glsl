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
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimage2D prt_transfer; // [entry][row]

vec3 prt_bounced(uint k, vec4 t)
{
    return t.x * light.direct[k].rgb + t.yzw * light.bounced[k].rgb;
}

vec3 prt_direct(uint k, vec4 t)
{
    vec3 sum = vec3(0.0);
    for (uint j = 0; j < 4u && k + j < COEFFICIENTS; j++) sum += t[j] * light.direct[k + j].rgb;
    return sum;
}

vec3 prt_row_irradiance(uint row, uint rows)
{
    vec3 sum = vec3(0.0);
    uint step = BOUNCES ? PRT_VECTOR_HALVES / 4u : PRT_VECTOR_HALVES;
    for (uint k = 0; k < COEFFICIENTS; k += step) {
        uvec4 words = imageLoad(prt_transfer, light_map_at(k / step * rows + row));
        vec4 first = light_map_unpack(words.xy), second = light_map_unpack(words.zw);
        if (!BOUNCES)
            sum += prt_direct(k, first) + prt_direct(k + 4u, second);
        else
            sum += prt_bounced(k, first);
        if (BOUNCES && k + 1u < COEFFICIENTS) sum += prt_bounced(k + 1u, second);
    }
    return sum;
}

// Irradiance by the visible part of a sky of radiance 1, without bounces.
float prt_row_sky(uint row)
{
    return light_map_unpack(imageLoad(prt_transfer, light_map_at(row)).xy).x / SH_Y0;
}

#endif
