// Saturating conversions of floating-point numbers to integers. A plain cast is undefined where the
// value is out of range or NaN (C17, 6.3.1.4), and gives INT_MIN on x86.
#pragma once

#include <stdint.h>

// The value truncated towards zero and clamped to [min, max]; min for NaN.
static inline int int_saturated(double value, int min, int max)
{
    return !(value > (double)min) ? min : value >= (double)max ? max : (int)value;
}

static inline uint32_t uint32_saturated(double value, uint32_t min, uint32_t max)
{
    return !(value > (double)min) ? min : value >= (double)max ? max : (uint32_t)value;
}

// 2^64 is exact, UINT64_MAX as a double is not.
static inline uint64_t uint64_saturated(double value)
{
    return !(value > 0.0) ? 0 : value >= 0x1p64 ? UINT64_MAX : (uint64_t)value;
}
