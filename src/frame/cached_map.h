// Reuse of shadow maps and reflective shadow maps: a map is valid from the previous frame if its
// transform is the same and nothing inside its clip volume moved, was added or removed.
#pragma once

#include "frame/frame_shared.h"
#include "frame/scene/scene_gpu.h"

struct cached_map { // zero: invalid
    struct frame_light light;
    mat4s clip_from_world;
    uint64_t updates; // scene_gpu.updates when the map was last valid; 0: never
};

// Whether the map is still valid; `materials`: it shows them, too. Call once per frame, before
// rendering: the map counts as rendered from then on.
bool cached_map_is_valid(struct cached_map *map, const struct scene_gpu *scene,
                         const struct frame_light *light, mat4s clip_from_world, bool materials);
