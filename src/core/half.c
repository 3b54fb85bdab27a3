#include "core/half.h"

#include <math.h>
#include <string.h>

static const float LARGEST = 65504.0f;
static const float SMALLEST_NORMAL = 6.103515625e-5f; // 2⁻¹⁴
static const float SUBNORMAL_UNITS = 16777216.0f;     // 2²⁴ per 1

uint16_t half_from_float(float value)
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

float float_from_half(uint16_t half)
{
    const uint32_t sign = (uint32_t)(half & 0x8000u) << 16, exponent = half >> 10 & 31u;
    const uint32_t fraction = half & 1023u;
    uint32_t bits = sign | (exponent + 127 - 15) << 23 | fraction << 13;
    if (exponent == 31) bits = sign | 255u << 23 | fraction << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    if (exponent > 0) return value;
    value = (float)fraction / SUBNORMAL_UNITS;
    return sign ? -value : value;
}
