// Bytes of display images, by the sRGB curve.
#pragma once

// The byte of a linear value: clamped to 0…1, rounded; NaN is 0.
unsigned char srgb_byte(float linear);
float srgb_linear(unsigned char byte); // 0…1
