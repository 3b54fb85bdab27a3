// What the shaders of light propagation volumes share with the host. Scalar layout.
#ifndef AG_LPV_SHARED_H
#define AG_LPV_SHARED_H

#include "core/shared.h"

#define LPV_TEXELS 4 // side of the block of texels of a reflective shadow map that one invocation injects
#define LPV_EMITTERS_LOCAL 64 // invocations of a workgroup that injects emissive surfaces, one point each

// Uniform block "lpv_grid".
struct lpv_params {
    vec3s origin_m;         // corner of cell 0, world space
    float cell_m;
    int32_t cells_x, cells_y, cells_z; // in use; beyond them is the outside
    int32_t dim;            // side of the images
    float keep, drive, aim, along, across; // struct lpv_step
    float fixed_from_flux;  // integer per scaled lumen
    float grid_from_fixed;  // the grid's unit per integer
    float irradiance_scale; // scaled lux per ∫ intensity · (cosine)₊ dω in the grid's unit
    float offset_m;         // of the look-up, along the normal
    float window;           // weight of band 1 at the look-up
    uint32_t rsm_size;      // texels
    uint32_t width, height; // of the frame, pixels
    uint32_t emitter_count;
};

// Views of lpv_debug.comp.
#define LPV_VIEW_INJECTED 0
#define LPV_VIEW_PROPAGATED 1
#define LPV_VIEW_CELLS 2

struct lpv_view_push {
    uint32_t view;
    float radiance_scale; // scaled cd/m² per flux of a cell in the grid's unit
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct lpv_params) == 22 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_view_push) == 8, "layout is shared with GLSL");
#endif

#endif
