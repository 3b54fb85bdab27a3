// A light's map that would come out as it is need not be drawn again: nothing moves where it looks,
// and it looks from where it did in the last frame.
#pragma once

#include "frame/frame_shared.h"
#include "frame/scene_gpu.h"

struct kept_map { // zero: nothing is kept
    struct frame_light light;
    mat4s clip_from_world;
    uint64_t updates; // of the scene when it was last as it should be; 0: never
};

// Whether the map stands as it was. Call once a frame, before it is drawn: it counts as drawn from
// then on.
bool kept_map_stands(struct kept_map *map, const struct scene_gpu *scene,
                     const struct frame_light *light, mat4s clip_from_world);
