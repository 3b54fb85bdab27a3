// Three unsigned floats that share an exponent, in 32 bits: VK_FORMAT_E5B9G9R9_UFLOAT_PACK32
// (Khronos Data Format Specification, "Unsigned 9995 shared exponent").
#pragma once

#include <stdint.h>

#define RGB9E5_MAX 65408.0f

// The nearest values; negative ones and NaN become 0, larger ones RGB9E5_MAX.
uint32_t rgb9e5_pack(const float rgb[3]);
void rgb9e5_unpack(uint32_t packed, float rgb[3]);
