// The geometry volume, the occluders of the light (Martin 2012, sec. 3.2.2; Hong 2015,
// sec. 2.5.2.4). docs/notes/lpv.md compares its sources.
#pragma once

#include "gpu/gpu.h"
#include "techniques/lpv/lpv_history.h"

// The occluders of a cascade.
struct lpv_geometry {
    gpu_image volume;         // RGBA16F: geometry.glsl
    gpu_buffer walls;         // LPV_GEOMETRY_SCENE: [cell] lpv_lookup.glsl
    gpu_buffer transmittance; // [cell][word]: geometry_transmittance.glsl
    gpu_buffer surfels;       // LPV_GEOMETRY_MAPS: [corner][coefficient] of one source
    // LPV_GEOMETRY_SCENE: [cell][axis] coverage masks of static and of moving geometry.
    gpu_buffer static_coverage, moving_coverage;

    struct lpv_statics statics; // of the volume
    float occlusion;            // the option, of the transmittance
};

struct lpv_geometry_pipelines {
    gpu_pipeline light, camera, merge;             // LPV_GEOMETRY_MAPS
    gpu_pipeline coverage, masked_coverage, faces; // LPV_GEOMETRY_SCENE
    gpu_pipeline transmittance;
};

struct lpv_cascade;
struct lpv_frame;

// Changes cascade->geometry; nothing where the option `geometry` is off.
void lpv_record_geometry(const struct lpv_geometry_pipelines *pipelines,
                         const struct lpv_frame *frame, struct lpv_cascade *cascade);

// geometry_maps.c, geometry_scene.c: the two sources. The second returns false where the cached
// volume is still valid.
void lpv_record_geometry_maps(const struct lpv_geometry_pipelines *pipelines,
                              const struct lpv_frame *frame, const struct lpv_cascade *cascade);
bool lpv_record_geometry_scene(const struct lpv_geometry_pipelines *pipelines,
                               const struct lpv_frame *frame, struct lpv_cascade *cascade);
