// Reflective shadow maps of all lights (Dachsbacher & Stamminger 2005). Suns and spots have one
// face, points six. Lookup: rsm.glsl.
#pragma once

#include "frame/frame_shared.h"
#include "frame/cached_map.h"
#include "frame/scene/scene_gpu.h"

struct rsm {
    struct host *host;
    struct gpu *gpu;
    uint32_t size; // texels
    gpu_pipeline pipelines[VARIANT_COUNT];
    gpu_image depth, normal, flux; // arrays
    int capacity;                  // layers; 0: no images
    struct rsm_face *faces;        // [capacity]
    struct cached_map *cache;      // [capacity]
    int face_count;                // in this frame
    int drawn;                     // faces rendered in this frame, not reused
};

bool rsm_init(struct rsm *rsm, struct host *host, struct gpu *gpu, uint32_t size);
void rsm_finish(struct rsm *rsm); // accepts zero
int rsm_faces_of(uint32_t light_type);
// Allocates face_count layers (0: frees the images), and creates pipelines for these variants (bit
// v: variant v).
bool rsm_prepare(struct rsm *rsm, int face_count, uint32_t variants);
// The pipelines alone, for a compiler.
bool rsm_compile(struct gpu *compiler, uint32_t variants);
// Computes the faces of these lights in order. Lights beyond the capacity get none.
void rsm_place(struct rsm *rsm, const struct frame_light *lights, int light_count,
               struct box3 bounds);
// bindings: frame_constants, frame_lights and rsm_faces. reuse: skip maps that are valid from the
// previous frame.
void rsm_record(struct rsm *rsm, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                const struct frame_light *lights, const struct gpu_binding bindings[3], bool reuse);
