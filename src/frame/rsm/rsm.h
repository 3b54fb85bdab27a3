// Reflective shadow maps of all lights (Dachsbacher & Stamminger 2005): what each light sees. Suns
// and spots have one face, points six. How to read them: rsm.glsl.
#pragma once

#include "frame/frame_shared.h"
#include "frame/kept_map.h"
#include "frame/scene_gpu.h"

struct rsm {
    struct host *host;
    struct gpu *gpu;
    uint32_t size; // texels
    gpu_pipeline pipelines[VARIANT_COUNT];
    gpu_image depth, normal, flux; // arrays
    int capacity;                  // layers; 0: no images
    struct rsm_face *faces;        // [capacity]
    struct kept_map *kept;         // [capacity]
    int face_count;                // this frame's
    int drawn;                     // of them, those that were drawn anew
};

bool rsm_init(struct rsm *rsm, struct host *host, struct gpu *gpu, uint32_t size);
void rsm_finish(struct rsm *rsm); // accepts zero
int rsm_faces_of(uint32_t light_type);
// Room for so many faces (0: frees the images), and pipelines for these variants (bit v: variant
// v).
bool rsm_prepare(struct rsm *rsm, int face_count, uint32_t variants);
// Places the faces of these lights, in their order. Lights that find no room get none.
void rsm_place(struct rsm *rsm, const struct frame_light *lights, int light_count,
               struct box3 bounds);
// bindings: frame_constants, frame_lights and rsm_faces. keep: maps that would come out as they are
// stay as they are.
void rsm_record(struct rsm *rsm, struct gpu_cmd *cmd, const struct scene_gpu *scene,
                const struct frame_light *lights, const struct gpu_binding bindings[3], bool keep);
