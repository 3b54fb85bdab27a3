// 16-bit floats (IEEE 754 binary16).
#pragma once

#include <stdint.h>

// Rounds to nearest, ties to even; beyond the range of half floats to ±65504.
uint16_t half_from_float(float value);
float float_from_half(uint16_t half);
