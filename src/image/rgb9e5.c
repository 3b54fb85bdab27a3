#include "image/rgb9e5.h"

#include <math.h>

enum { MANTISSA_BITS = 9, EXPONENT_BIAS = 15, EXPONENT_SHIFT = 27 };

static float clamped(float value)
{
    return value > 0.0f ? fminf(value, RGB9E5_MAX) : 0.0f;
}

static uint32_t mantissa(float value, int exponent)
{
    return (uint32_t)floorf(ldexpf(value, EXPONENT_BIAS + MANTISSA_BITS - exponent) + 0.5f);
}

uint32_t rgb9e5_pack(const float rgb[3])
{
    const float r = clamped(rgb[0]), g = clamped(rgb[1]), b = clamped(rgb[2]);
    const float most = fmaxf(r, fmaxf(g, b));
    int exponent = 0;
    frexpf(most, &exponent); // most < 2^exponent
    exponent = exponent > -EXPONENT_BIAS && most > 0.0f ? exponent + EXPONENT_BIAS : 0;
    if (mantissa(most, exponent) == 1u << MANTISSA_BITS) exponent++; // rounded up
    return (uint32_t)exponent << EXPONENT_SHIFT | mantissa(b, exponent) << 2 * MANTISSA_BITS |
           mantissa(g, exponent) << MANTISSA_BITS | mantissa(r, exponent);
}

void rgb9e5_unpack(uint32_t packed, float rgb[3])
{
    const int exponent = (int)(packed >> EXPONENT_SHIFT) - EXPONENT_BIAS - MANTISSA_BITS;
    for (int c = 0; c < 3; c++)
        rgb[c] = ldexpf((float)(packed >> c * MANTISSA_BITS & 0x1ffu), exponent);
}
