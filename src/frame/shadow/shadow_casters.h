// Draws of what casts shadows into a depth map: both sides of all triangles, with the alpha test of
// masked materials.
#pragma once

#include "frame/scene/scene_gpu.h"

struct shadow_casters {
    struct gpu *gpu;
    gpu_pipeline opaque, masked[2]; // [with a base-colour map]
};

bool shadow_casters_init(struct shadow_casters *casters, struct gpu *gpu);
void shadow_casters_finish(struct shadow_casters *casters); // accepts zero

struct shadow_map_target {
    gpu_image maps; // D32F array: 0 where there is no surface
    uint32_t layer, size;
    mat4s clip_from_world;
    // Instances that cast no shadow, and whose draws are skipped: instance_count from
    // first_instance on. Draws that are outside of `bounds` are, too, unless it is empty.
    uint32_t first_instance, instance_count;
    struct box3 bounds;
};
// Clears the layer and draws.
void shadow_casters_record(const struct shadow_casters *casters, struct gpu_cmd *cmd,
                           const struct scene_gpu *scene, const struct shadow_map_target *target);
