// Index of a pixel in a pattern that repeats every 4 × 4 pixels: a Bayer matrix.
#ifndef AG_PATTERN_GLSL
#define AG_PATTERN_GLSL

uint pattern_4x4(uvec2 pixel)
{
    uint x = pixel.x ^ pixel.y;
    return (x & 1u) << 3 | (pixel.y & 1u) << 2 | (x & 2u) | (pixel.y & 2u) >> 1;
}

#endif
