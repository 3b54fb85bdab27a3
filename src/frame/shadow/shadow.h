// Shadow maps of all lights: the layers of two arrays. Maps of suns cover the scene, those of
// points and spots their surroundings; the latter have half the size, since a point light has six.
#pragma once

#include "frame/frame_camera.h"
#include "frame/frame_shared.h"
#include "frame/cached_map.h"
#include "frame/shadow/shadow_casters.h"
#include "frame/shadow/shadow_shared.h"
#include "frame/shadow/shadow_sun_shared.h"

struct shadow {
    struct host *host;
    struct gpu *gpu;
    uint32_t sun_size, size; // texels: maps of suns, of other lights
    uint32_t cascades;       // per sun
    struct shadow_casters casters;
    gpu_image sun_maps, maps;   // D32F arrays; 8×8×1 if empty
    int sun_capacity, capacity; // layers
    gpu_sampler sampler;        // comparison sampler
    struct shadow_face *faces;  // [sun_capacity + capacity]
    struct cached_map *cache;   // [sun_capacity + capacity]
    gpu_pipeline block_pipeline;
    gpu_image sun_blocks; // bounds of sun_maps, shadow_blocks.comp
    bool *has_blocks;     // [sun_capacity + capacity]: of the map last drawn
    gpu_sampler nearest;
    int face_count; // in this frame
    int drawn;      // faces rendered in this frame, not reused
};

// Inputs of the layout of sun cascades.
struct shadow_view {
    struct frame_camera camera;
    struct box3 bounds; // of the scene
    float cascade_blend;
    int filter_radius; // texels
};

// sun_size: texels of a sun's map; other maps have half of it.
bool shadow_init(struct shadow *shadow, struct host *host, struct gpu *gpu, uint32_t sun_size,
                 uint32_t cascades);
void shadow_finish(struct shadow *shadow); // accepts zero
// Number of layers for a light of this type.
int shadow_faces_of(const struct shadow *shadow, uint32_t light_type);
// Allocates layers for the faces of suns and of other lights.
bool shadow_prepare(struct shadow *shadow, int sun_faces, int faces);

// Computes the map transforms and sets shadow_first and shadow_count of the lights. Lights beyond
// the capacity cast no shadow.
void shadow_place(struct shadow *shadow, struct frame_light *lights, int light_count,
                  const struct shadow_view *view);
// reuse: skip maps that are valid from the previous frame.
void shadow_record(struct shadow *shadow, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                   const struct frame_light *lights, int light_count, bool reuse);

// Makes the blocks of a sun's maps if all maps were valid in this frame: those of moving scenes are
// not worth it. false: a map has no blocks.
bool shadow_record_blocks(struct shadow *shadow, struct gpu_cmd *cmd,
                          const struct frame_light *sun);

// shadow_cascades.c: the `count` maps of one sun.
void shadow_place_sun(const struct shadow *shadow, struct shadow_face *faces, int count,
                      vec3s direction, const struct shadow_view *view);

// shadow_sun_view.c: the `count` maps of one sun, seen from `eye`.
struct shadow_sun_view shadow_view_of_sun(const struct shadow_face *faces, int count, vec3s eye);
// Whether positions in the maps are precise enough for their blocks.
bool shadow_view_is_precise(const struct shadow_sun_view *view, const struct shadow_face *faces,
                            int count);
