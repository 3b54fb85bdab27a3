// The private state of light propagation volumes, shared by all stages.
#pragma once

#include "techniques/common/kept.h"
#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_history.h"
#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_shared.h"
#include "techniques/technique.h"

struct lpv_options {
#define OPTION OPTION_FIELD
#include "techniques/lpv/lpv_options.def"
#undef OPTION
};

enum lpv_reconstruction { LPV_LINEAR, LPV_CUBIC };
enum lpv_closure { LPV_CLOSURE_LINEAR, LPV_CLOSURE_POSITIVE };
enum lpv_precision { LPV_PRECISION_HALF, LPV_PRECISION_FLOAT };

// Images and buffers over the cells of a grid. A light volume is one image: its slabs of dim³
// texels follow each other along z (lpv_light.glsl). Members from `light` on are of one cascade.
struct lpv_volumes {
    gpu_buffer sums;    // [cell][coefficient][colour] 64-bit integers
    gpu_image injected; // injected light
    gpu_image steps[2]; // ping-pong of propagation; half precision: `light` replaces steps[1]
    gpu_image probes;   // RGBA16F: irradiance probes
    gpu_image sent;     // bounces: injected light + light that surfaces reflect

    gpu_image light;     // RGBA16F: accumulated over all steps
    gpu_buffer surfaces; // bounces: [cell][direction][colour] reflecting area (lpv_surfaces.comp)
    // Occlusion.
    gpu_image geometry;       // RGBA16F: the geometry volume (geometry.glsl)
    gpu_buffer walls;         // LPV_GEOMETRY_SCENE: [cell] lpv_lookup.glsl
    gpu_buffer transmittance; // [cell][word]: geometry_transmittance.glsl
    gpu_buffer surfels;       // LPV_GEOMETRY_MAPS: [corner][coefficient] of one source
    // LPV_GEOMETRY_SCENE: [cell][axis] coverage masks of static and of moving geometry.
    gpu_buffer static_coverage, moving_coverage;
};

struct lpv_pipelines {
    gpu_pipeline inject, inject_emitters, resolve;
    gpu_pipeline surfaces, masked_surfaces, bounce;
    gpu_pipeline refine, propagate;
    gpu_pipeline apply, apply_damped, probes, debug;
    gpu_pipeline geometry_light, geometry_camera, geometry_merge;    // LPV_GEOMETRY_MAPS
    gpu_pipeline geometry_coverage, masked_coverage, geometry_faces; // LPV_GEOMETRY_SCENE
    gpu_pipeline geometry_transmittance;
};

struct lpv_geometry_cache {
    struct lpv_statics statics; // of the geometry volume
    float occlusion;            // the option
};

struct lpv_surface_cache {
    struct lpv_statics statics; // of the buffer `surfaces`
    bool at_rest;               // it holds moving draws, too; else `sums` holds all of this frame
};

// One grid, or one of several cascades. Coarser cascades share the pipelines and all volumes of the
// finest that are not of one cascade.
struct lpv {
    struct lpv_options options;
    struct gpu *gpu;
    gpu_sampler linear;
    struct lpv_pipelines pipelines;
    struct lpv_volumes volumes;
    struct lpv_geometry_cache geometry;
    struct lpv_surface_cache surfaces;
    struct kept kept;
    struct lpv_grid grid;
    struct lpv_params params; // of the frame being recorded
    bool lit;                 // the frame being recorded has light and a scene with extent
    struct lpv *coarser;      // the next cascade; NULL: this is the coarsest
};

// Any buffer where there are no walls.
static inline gpu_buffer lpv_walls(const struct lpv *lpv)
{
    return lpv->options.geometry == LPV_GEOMETRY_SCENE ? lpv->volumes.walls : lpv->volumes.sums;
}

// The state of the technique.
struct lpv_cascades {
    struct lpv levels[LPV_MAX_CASCADES]; // from the finest
};

// LPV_…_CLOSURE: of two bands over six neighbours, and of three over 26.
static inline uint32_t lpv_closure_of(const struct lpv_options *options)
{
    const bool six = options->neighbours == LPV_SIX;
    if (options->closure == LPV_CLOSURE_LINEAR || six != (options->bands == 2))
        return LPV_NO_CLOSURE;
    return six ? LPV_BEAM_CLOSURE : LPV_PRODUCT_CLOSURE;
}

// Empty cells around the scene. At least a half: every surface lies between the centres of two
// cells. With a sky at least one: its light enters through cells without surfaces.
static inline float lpv_margin(const struct lpv_options *options, vec3s sky)
{
    const bool has_sky = options->sky && fmaxf(sky.x, fmaxf(sky.y, sky.z)) > 0.0f;
    return has_sky ? fmaxf(options->cell_margin, 1.0f) : options->cell_margin;
}
