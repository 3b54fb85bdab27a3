// The private state of light propagation volumes, shared by its stages.
#pragma once

#include "techniques/lpv/lpv_bounce.h"
#include "techniques/lpv/lpv_geometry.h"
#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_probes.h"
#include "techniques/lpv/lpv_shared.h"
#include "techniques/technique.h"

struct lpv_options {
#define OPTION OPTION_FIELD
#include "techniques/lpv/lpv_options.def"
#undef OPTION
};

#define LPV_LOCAL       8       // of shaders of cells or pixels, in x and y
#define LPV_AREA_BYTES  (4 * 4) // of a corner's sums
#define LPV_LINES_BYTES (3 * 4) // of a cell's low faces

enum lpv_reconstruction { LPV_LINEAR, LPV_CUBIC };
enum lpv_precision { LPV_PRECISION_HALF, LPV_PRECISION_FLOAT };

// Texels of a cell: 12 or 27 coefficients, four to a texel (lpv_light.glsl).
static inline uint32_t lpv_slabs(const struct lpv_options *options)
{
    return options->bands == 3 ? 7 : 3;
}

static inline size_t lpv_cell_bytes(const struct lpv_options *options) // of a cell's 64-bit sums
{
    return 4 * (size_t)lpv_slabs(options) * 8;
}

// Cells around the scene. What comes in through the border finds a whole one free of surfaces.
static inline float lpv_margin(const struct lpv_options *options, vec3s sky)
{
    const bool enters = options->sky && fmaxf(sky.x, fmaxf(sky.y, sky.z)) > 0.0f;
    return enters ? fmaxf(options->cell_margin, 1.0f) : options->cell_margin;
}

// Of passes and objects, "technique.thing".
struct lpv_names {
    const char *gi;
    const char *inject, *inject_emitters, *resolve, *geometry, *surfaces, *refine, *propagate;
    const char *apply, *probes, *debug;
    const char *sums, *injected, *reflected, *sent, *steps[2], *light, *coarser_light, *linear;
    struct lpv_geometry_names of_geometry;
};

// One grid, or one of several cascades. Coarser ones have all objects of the finest but the light.
struct lpv {
    const struct lpv_names *names;
    struct gpu *gpu;
    struct lpv_options options;
    gpu_sampler linear;
    gpu_pipeline inject, inject_emitters, resolve, refine, propagate, apply, apply_damped, debug;
    gpu_pipeline propagate_held; // what geometry holds back; none without geometry
    gpu_buffer sums;             // [cell][coefficient][colour] 64-bit integers
    gpu_image injected;          // volumes: dim² × slabs · dim texels
    gpu_image steps[2]; // in turn; with half precision only the first, and `light` is the other
    gpu_image light;    // RGBA16F: accumulated over all steps
    struct lpv_geometry geometry;
    struct lpv_probes probes;
    struct lpv_bounce bounce;
    struct lpv_grid grid;
    struct lpv_params params; // of the frame being recorded
    bool lit;                 // the frame being recorded has light and something to light
    struct lpv *coarser;      // the next cascade; NULL: this is the coarsest
};

// The state of the technique.
struct lpv_cascades {
    struct lpv levels[LPV_MAX_CASCADES]; // from the finest
};

bool lpv_create_volume(struct lpv *lpv, const char *name, enum gpu_format format, gpu_image *out);
// The coarser cascades, of a finest one that is complete.
bool lpv_cascades_create(struct lpv_cascades *cascades);
void lpv_cascades_destroy(struct lpv_cascades *cascades);
// Gives each cascade its grid; false: the scene has no extent.
bool lpv_cascades_place(struct lpv *finest, const struct frame_view *view);

// Places the grid and chooses the scales; false where there is nothing to do.
bool lpv_prepare(struct lpv *lpv, const struct frame_view *view);
// Grid and parameters as the shaders read them; a dispatch whose invocations take `run` cells along
// z each.
struct gpu_binding lpv_grid_binding(struct lpv *lpv, struct gpu_cmd *cmd);
void lpv_dispatch_cells(struct lpv *lpv, struct gpu_cmd *cmd, gpu_pipeline pipeline, uint32_t run,
                        const struct gpu_binding *bindings, int count);
// The stages, in order. Each reads lpv->params.
void lpv_record_injection(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
void lpv_record_propagation(struct lpv *lpv, struct gpu_cmd *cmd);
// Puts the light of the coarser cascade into `to`, which the first step reads.
void lpv_record_refinement(struct lpv *lpv, struct gpu_cmd *cmd, gpu_image to);
// Of all cascades.
void lpv_record_application(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
// Draws the view LPV_VIEW_… into `out` (RGBA16F of the frame's size).
void lpv_record_debug(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view,
                      uint32_t what, gpu_image out);
// The two ways to fill the geometry volume; that from the scene says whether it is another than it
// was.
void lpv_record_geometry_maps(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
bool lpv_record_geometry_scene(struct lpv *lpv, struct gpu_cmd *cmd, const struct frame_view *view);
