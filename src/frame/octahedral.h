// Octahedral encoding of unit vectors in −1…1 squared (Cigolle et al. 2014, "A Survey of Efficient
// Representations for Independent Unit Vectors", oct). GLSL twin: octahedral.glsl.
#pragma once

#include "core/vec.h"

#include <stdint.h>

static inline vec2s octahedral_encode(vec3s n)
{
    float sum = fabsf(n.x) + fabsf(n.y) + fabsf(n.z);
    vec2s p = { { n.x / sum, n.y / sum } };
    if (n.z >= 0.0f) return p;
    return (vec2s){ { (1.0f - fabsf(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f),
                      (1.0f - fabsf(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f) } };
}

static inline vec3s octahedral_decode(vec2s e)
{
    vec3s n = vec3_of(e.x, e.y, 1.0f - fabsf(e.x) - fabsf(e.y));
    float below = fmaxf(-n.z, 0.0f);
    n.x += n.x >= 0.0f ? -below : below;
    n.y += n.y >= 0.0f ? -below : below;
    return glms_vec3_normalize(n);
}

// Two 16-bit snorm values, x in the low half (GLSL: unpackSnorm2x16).
static inline uint32_t octahedral_pack(vec3s n)
{
    vec2s e = octahedral_encode(n);
    int x = (int)lrintf(e.x * 32767.0f), y = (int)lrintf(e.y * 32767.0f);
    return ((uint32_t)x & 0xffffu) | ((uint32_t)y << 16);
}
