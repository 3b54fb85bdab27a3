// Light maps by paths of scenes, with charts of a number of texels.
#pragma once

#include "framework/test.h"

#include "lightmap/lightmap.h"

// lightmap_bake.charts; options: const int *, texels of surfaces.
bool fixture_charts(const struct scene_pose *statics, const void *options, struct host *host,
                    const struct charts_search *begin, struct charts *out);

// Corners of a box around the origin, four to a side; sides face out, `inside`: in.
struct fixture_box {
    vec3s at[24];
    uint32_t indices[36];
};
struct fixture_box fixture_box(vec3s size, bool inside);

struct fixture_bake {
    const struct scene_pose *pose;
    int texels, samples;
    float noise;
    uint64_t seed;
    int threads; // 0: all cores
};
// Complete.
struct bake *fixture_bake(const struct fixture_bake *of);
const float *fixture_tensor(const struct bake *bake, const char *name);
// Luminance of a row of LIGHTMAP_REST, lux.
double fixture_luminance(const float *rest, size_t texel);

// As another engine: bilinear, v downwards. Texels that it reads are in the map.
vec3s fixture_lookup(const struct image *map, vec2s uv);
