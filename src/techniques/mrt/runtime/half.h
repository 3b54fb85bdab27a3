// 16-bit floats.
#pragma once

#include <stdint.h>

// Rounds to nearest, ties to even; beyond the range of half floats to ±65504.
uint16_t mrt_half_of(float value);
