// The plane that the texels of a block of a sun's shadow map lie on, and its encoding in four
// halves.
#ifndef AG_FRAME_SHADOW_PLANE_GLSL
#define AG_FRAME_SHADOW_PLANE_GLSL

#include "core/half.glsl"

struct shadow_plane {
    float height; // at the block's first texel, texels
    vec2 slope;
    // Whether all inner texels and what the test extrapolates are within shadow_deviation. Else the
    // height is below all occluders, without slope.
    bool is_exact;
};

float shadow_steepness(shadow_plane p)
{
    return abs(p.slope.x) + abs(p.slope.y);
}

// Below 1/3, the test clamps no slope that is within the deviation.
float shadow_deviation(shadow_plane p)
{
    return min(1.0 / 32.0 + shadow_steepness(p) / 16.0, 0.25);
}

// The height has two halves; the second is negative where the plane is not exact.
shadow_plane shadow_plane_of(vec4 texel)
{
    return shadow_plane(texel.x + abs(texel.y), texel.zw, texel.y >= 0.0);
}

// Values that halves represent, so that stores do not round. The height is at most 1e-4 above the
// plane's.
vec4 shadow_plane_texel(shadow_plane p)
{
    float high = half_rounded(p.height);
    if (high > p.height) high = half_rounded(high - max(abs(high), 1.0) / 512.0);
    float low = half_rounded(max(p.height - high, 1e-4));
    return vec4(high, p.is_exact ? low : -low, half_rounded(p.slope.x), half_rounded(p.slope.y));
}

#endif
