// Shadow maps of all lights: the layers of one array.
#pragma once

#include "frame/frame_shared.h"
#include "frame/kept_map.h"
#include "frame/scene_gpu.h"
#include "frame/shadow/shadow_shared.h"

struct shadow {
    struct host *host;
    struct gpu *gpu;
    uint32_t size;                  // texels
    uint32_t cascades;              // of a sun
    gpu_pipeline opaque, masked[2]; // [with a base-colour map]
    gpu_image maps;                 // D32F array; 8×8×1 where there is nothing to shadow
    int capacity;                   // layers
    gpu_sampler sampler;            // compares
    struct shadow_face *faces;      // [capacity]
    struct kept_map *kept;          // [capacity]
    int face_count;                 // this frame's
    int drawn;                      // of them, those that were drawn anew
};

// How the cascades of suns are laid out.
struct shadow_view {
    struct world_camera camera;
    float aspect;       // width / height
    struct box3 bounds; // of the scene
    float cascade_blend;
    int filter_radius; // texels
};

bool shadow_init(struct shadow *shadow, struct host *host, struct gpu *gpu, uint32_t size,
                 uint32_t cascades);
void shadow_finish(struct shadow *shadow); // accepts zero
// Layers that a light of this type needs.
int shadow_faces_of(const struct shadow *shadow, uint32_t light_type);
// Room for so many layers.
bool shadow_prepare(struct shadow *shadow, int face_count);

// Places the maps of these lights and sets their shadow_first and shadow_count. A light that finds
// no room casts no shadow.
void shadow_place(struct shadow *shadow, struct frame_light *lights, int light_count,
                  const struct shadow_view *view);
// keep: maps that would come out as they are stay as they are.
void shadow_record(struct shadow *shadow, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                   const struct frame_light *lights, int light_count, bool keep);

// shadow_cascades.c: the maps of one sun, `count` of them.
void shadow_place_sun(const struct shadow *shadow, struct shadow_face *faces, int count,
                      vec3s direction, const struct shadow_view *view);
