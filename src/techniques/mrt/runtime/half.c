#include "half.h"

#include <math.h>
#include <string.h>

static const float LARGEST = 65504.0f;
static const float SMALLEST_NORMAL = 6.103515625e-5f; // 2⁻¹⁴
static const float SUBNORMAL_UNITS = 16777216.0f;     // 2²⁴ per 1

uint16_t mrt_half_of(float value)
{
    uint32_t bits;
    float size = fminf(fabsf(value), LARGEST);
    const uint16_t sign = signbit(value) ? 0x8000 : 0;
    // rintf rounds ties to even; the result may be the smallest normal, whose bits follow.
    if (size < SMALLEST_NORMAL) return (uint16_t)(sign | (uint16_t)rintf(size * SUBNORMAL_UNITS));
    memcpy(&bits, &size, sizeof bits);
    bits += 0xfff + (bits >> 13 & 1u);
    return (uint16_t)(sign | (uint16_t)((bits >> 13) - ((127 - 15) << 10)));
}
