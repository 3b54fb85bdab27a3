#include "srgb.h"

#include "image/srgb.h"

#include <math.h>

unsigned char srgb_byte(float linear)
{
    const float clamped = fminf(fmaxf(linear, 0.0f), 1.0f); // fmaxf also removes NaN
    return (unsigned char)(255.0f * srgb_encode(clamped) + 0.5f);
}

float srgb_linear(unsigned char byte)
{
    return srgb_decode((float)byte / 255.0f);
}
