// The map of the environment on the GPU: a cube of radiance whose mips are averaged over lobes of
// doubling width (environment_map.glsl).
#pragma once

#include "gpu/gpu.h"
#include "scene/environment.h"

struct frame_constants;

struct frame_environment {
    struct host *host;
    struct gpu *gpu;
    const struct environment_map *map; // of the cube, with a reference; NULL: none, it is black
    gpu_image cube;                    // RGBA16F: radiance × texel_scale; the scene's memory
    gpu_sampler sampler;
    float texel_scale; // a power of two: the largest texel is below 2¹⁵
    uint32_t side;     // texels of the finest level
    // Radiance of the environment with this key, cd/m².
    bool known;
    uint64_t key;
    float sh[3][SH_MAX_COUNT]; // 3 bands
    vec3s patches[ENVIRONMENT_PATCHES];
};

bool frame_environment_init(struct frame_environment *e, struct host *host, struct gpu *gpu);
void frame_environment_finish(struct frame_environment *e); // accepts zero
// Adapts the cube to another map. Turning and dimming it needs nothing.
bool frame_environment_prepare(struct frame_environment *e, const struct environment *environment);
// Computes coefficients and patches where the environment has changed. Returns its key.
uint64_t frame_environment_follow(struct frame_environment *e,
                                  const struct environment *environment);
// The members of the block that begin with `environment`, after that. Needs radiance_scale.
void frame_environment_constants(const struct frame_environment *e,
                                 const struct environment *environment,
                                 struct frame_constants *out);
