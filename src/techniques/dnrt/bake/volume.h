// The volume of an object: coefficients m = t − k at the points of a grid, and their encoding.
#pragma once

#include "core/host.h"
#include "core/vec.h"

#include <math.h>
#include <stdint.h>

// A cube around the object's centre, with samples on its faces: sample (x, y, z), each below
// `size`, at centre + half · (u, …) with u = 2 x/(size − 1) − 1, or u |u| if quadratic (appendix
// B.1).
struct dnrt_grid {
    vec3s centre;
    float half; // of an edge, m
    int size;
    bool quadratic;
};

static inline int dnrt_grid_count(int size)
{
    return size * size * size;
}

static inline vec3s dnrt_grid_point(const struct dnrt_grid *grid, int index)
{
    const int n = grid->size, xyz[3] = { index % n, index / n % n, index / (n * n) };
    vec3s p = grid->centre;
    for (int i = 0; i < 3; i++) {
        const float u = 2.0f * (float)xyz[i] / (float)(n - 1) - 1.0f;
        p.raw[i] += grid->half * (grid->quadratic ? u * fabsf(u) : u);
    }
    return p;
}

// Samples inside of the object get the mean of neighbours that are outside, layer after layer, so
// that interpolation near a surface has none of the darkness within. values: [samples][per_sample].
// False without memory.
bool dnrt_fill_inside(struct host *host, int size, int per_sample, const uint8_t *is_inside,
                      float *values);

// A plane of one coefficient and colour: [samples] divided by its scale, the largest magnitude.
// from: [samples][stride]. Half floats, or bytes of value · 127 + 128.
float dnrt_encode_half(const float *from, int samples, int stride, uint16_t *to);
float dnrt_encode_byte(const float *from, int samples, int stride, uint8_t *to);
