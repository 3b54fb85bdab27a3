// Painted light as it was painted: dabs of a brush, in their order.
#pragma once

#include <stdbool.h>

enum { DABS_MOST = 8192 };

struct dab {
    float position[3], normal[3]; // m; unit vector of the surface
    float radius;                 // m
    float lux[3];                 // irradiance in the middle; 0 removes paint
};

struct dabs {
    int count, capacity;
    struct dab *at;
};

// False: DABS_MOST are there, or out of memory.
bool dabs_add(struct dabs *dabs, const struct dab *dab);
bool dabs_copy(struct dabs *to, const struct dabs *from); // false: out of memory
bool dabs_same(const struct dabs *a, const struct dabs *b);
void dabs_close(struct dabs *dabs); // accepts zero
// The share of a texel's irradiance that becomes that of the dab: 1 in the middle, 0 at the radius
// and behind the surface, as on the other side of a wall. texel_m: the side of a texel.
float dab_weight(const struct dab *dab, const float texel[3], float texel_m);
