// Data that all tasks of a bake share, and names of tensors that live during the bake alone.
#pragma once

#include "scene/statics.h"
#include "techniques/ort/bake/near.h"
#include "techniques/ort/ort_tensors.h"
#include "trace/texels/close.h"
#include "trace/texels/texels.h"

struct ort_scene {
    struct host *host;
    const struct scene_pose *pose;
    struct ort_options options;
    struct ort_map map; // made while planning
    uint64_t columns;   // of emission, at least 1; likewise
    // Between prepare and finish:
    struct scene_statics statics;
    struct trace_scene *trace;
    struct seam_closing closing;
    uint32_t *patch_of;        // [texels]
    struct ort_kernel *kernel; // NULL: no light scatters below surfaces
    struct ort_near near;      // with a kernel
    struct ort_strip *strips;  // [texels] with a kernel
};

#define ORT_HITS    "texels/hit" // U32 [texels][rays]: texel that a ray meets; CHART_NONE: none
#define ORT_BOUNCES "patches/transfer" // F32 [3][patches][patches], see bounces.c
#define ORT_PATCHES "patches/patch"    // F32 [patches][5], struct ort_patch
#define ORT_AREAS   "areas"            // F32 [offsets][texels]: TVA (equation 8), m²

// Means of the texels of a patch by area.
struct ort_patch {
    float area;           // m²
    float reflectance[3]; // of first-order light
    float diffuse;        // factor of light from all sides, see light_map_first_order
};

// The surface of a texel, from the first stage of the bake.
struct ort_texel {
    vec3s position, normal;
    float reach; // offset of rays that leave it, m
    float area;  // m²; 0: it is inside geometry
    float reflectance[3], diffuse;
};
