// Directions of rays: one in each of the strata of a hemisphere, at a point that differs from tile
// to tile of pixels. Directions that all pixels share would draw an edge each at every occluder.
//
// Strata are the cells of a grid on the unit square, mapped to a disk and on to a hemisphere with
// equal areas (Shirley & Chiu 1997). Points of the R2 sequence (Roberts 2018) are taken along the
// Morton curve over an image's tiles: near tiles have complementary points (Ahmed & Wonka 2020), so
// that a mean over them has less variance than one over random points.
#ifndef AG_VCT_JITTER_GLSL
#define AG_VCT_JITTER_GLSL

// Bit i of x to bit 2 i.
uint vct_spread_bits(uint x)
{
    x &= 0xffffu;
    x = (x | x << 8) & 0x00ff00ffu;
    x = (x | x << 4) & 0x0f0f0f0fu;
    x = (x | x << 2) & 0x33333333u;
    return (x | x << 1) & 0x55555555u;
}

uint vct_morton(uvec2 at)
{
    return vct_spread_bits(at.x) | vct_spread_bits(at.y) << 1;
}

// Point `number` of R2; `set` shifts it. In 32-bit fixed point: exact.
vec2 vct_low_discrepancy(uint number, uint set)
{
    // 2^32 over the plastic number and over its square; for sets, over the golden ratio.
    uvec2 point = number * uvec2(3242174889u, 2447445414u) + set * uvec2(2654435769u, 1640531527u);
    return vec2(point >> 8u) / 16777216.0;
}

// A point of the unit square in cell `cell` of a grid of columns × rows.
vec2 vct_in_stratum(uint cell, uint columns, uint rows, vec2 jitter)
{
    return (vec2(cell % columns, cell / columns) + jitter) / vec2(columns, rows);
}

// Concentric map of the unit square to the unit disk.
vec2 vct_disk(vec2 square)
{
    vec2 at = 2.0 * square - 1.0;
    bool wide = abs(at.x) > abs(at.y);
    float r = wide ? at.x : at.y, other = wide ? at.y : at.x;
    float angle = 0.78539816 * other / (abs(r) > 0.0 ? r : 1.0);
    return r * (wide ? vec2(cos(angle), sin(angle)) : vec2(sin(angle), cos(angle)));
}

// Directions around +z, of uniform density over the solid angle, or in proportion to the cosine.
vec3 vct_uniform_direction(vec2 square)
{
    vec2 disk = vct_disk(square);
    float r2 = dot(disk, disk);
    return vec3(disk * sqrt(2.0 - r2), 1.0 - r2);
}

vec3 vct_cosine_direction(vec2 square)
{
    vec2 disk = vct_disk(square);
    return vec3(disk, sqrt(max(1.0 - dot(disk, disk), 0.0)));
}

#endif
