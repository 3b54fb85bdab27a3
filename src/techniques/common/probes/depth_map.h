// Places of a probe's octahedral map of depths: lookup.glsl.
#pragma once

#include "core/vec.h"
#include "frame/octahedral.h"

#include "techniques/common/probes/depth_shared.h"

#include <stdbool.h>

enum { PROBE_DEPTHS = PROBE_DEPTH_TILE * PROBE_DEPTH_TILE };

// The points of a triangle, and their weights at a place in it.
struct probe_depth_place {
    int point[3];
    float weight[3];
};

// x, y: in cells from the corner of the map.
static inline struct probe_depth_place probe_depth_place_at(float x, float y)
{
    enum { SIDE = PROBE_DEPTH_SIDE, TILE = PROBE_DEPTH_TILE };
    const int column = (int)fminf(x, SIDE - 1), row = (int)fminf(y, SIDE - 1);
    const bool mirrored = (column < SIDE / 2) != (row < SIDE / 2);
    const int near = row * TILE + column + (mirrored ? 1 : 0),
              beside = row * TILE + column + (mirrored ? 0 : 1);
    const float u = mirrored ? (float)(column + 1) - x : x - (float)column, v = y - (float)row;
    if (u + v <= 1.0f)
        return (struct probe_depth_place){ { near, beside, near + TILE }, { 1.0f - u - v, u, v } };
    return (struct probe_depth_place){ { beside + TILE, near + TILE, beside },
                                       { u + v - 1.0f, 1.0f - u, 1.0f - v } };
}

static inline struct probe_depth_place probe_depth_place_of(vec3s direction)
{
    const vec2s e = octahedral_encode(direction);
    const float half = 0.5f * PROBE_DEPTH_SIDE;
    return probe_depth_place_at(half * (e.x + 1.0f), half * (e.y + 1.0f));
}
