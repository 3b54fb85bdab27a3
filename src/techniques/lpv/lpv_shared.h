// Structs and constants that host and shaders of light propagation volumes share. Scalar layout.
#ifndef AG_LPV_SHARED_H
#define AG_LPV_SHARED_H

#include "core/shared.h"

#define LPV_LOCAL       8  // workgroup size in x and y of shaders over pixels
#define LPV_APPLY_LOCAL 64 // workgroup size in x of apply.comp
#define LPV_CELLS_LOCAL 64 // workgroup size of shaders over cells
// Side of the block of reflective shadow map texels that one invocation takes.
#define LPV_TEXELS         4
#define LPV_EMITTERS_LOCAL 64 // workgroup size of the injection of emissive surfaces
// Cells along z of an invocation with 26 neighbours; divides every dimension.
#define LPV_RUN 8

// Sampling lines along each side of a cell's face: of reflecting surfaces, of coverage masks.
#define LPV_SURFACE_LINES 4
#define LPV_LINES         4
#define LPV_PLACES        16u     // of a surface between two cells' centres
#define LPV_MOST_LINES    15u     // of a wall between two centres, in four bits
#define LPV_SURFACE_UNIT  65536.0 // of reflectance × area, per cells²

#define LPV_MAX_CASCADES     4
#define LPV_OPEN(axis, high) (1u << (2 * (axis) + (high))) // bit of a grid's side
// Cells before an open side over which a cascade blends into the next coarser one.
#define LPV_TRANSITION 4.0

// Specialization constants.
#define LPV_CONSTANT_BANDS      0 // 2 or 3
#define LPV_CONSTANT_HALF       1 // volumes are half floats
#define LPV_CONSTANT_GEOMETRY   2 // LPV_GEOMETRY_…
#define LPV_CONSTANT_NEIGHBOURS 3 // 6 or 26
#define LPV_CONSTANT_CUBIC      4 // cubic reconstruction between cells, or trilinear
#define LPV_CONSTANT_DAMPED     5 // damping is on
#define LPV_CONSTANT_CLOSURE    6 // LPV_…_CLOSURE

// Light of a cell: linear in all bands; two bands closed by lpv_closure.glsl, three by
// lpv_product.glsl.
#define LPV_NO_CLOSURE      0
#define LPV_BEAM_CLOSURE    1
#define LPV_PRODUCT_CLOSURE 2

// Source of the geometry volume: none, surfels of maps and camera, triangles of the scene.
#define LPV_GEOMETRY_OFF   0
#define LPV_GEOMETRY_MAPS  1
#define LPV_GEOMETRY_SCENE 2
// Words of a cell's transmittance with 6 and with 26 neighbours.
#define LPV_TRANSMITTANCE_WORDS_6  3
#define LPV_TRANSMITTANCE_WORDS_26 9

// A class of equivalent faces: direction (p, q, 0) or (p, q, q) in some order of the axes, solid
// angle Ω, and the axis (lobe_p, lobe_q, …) of the re-projected lobes. See propagate.comp.
struct lpv_reprojection {
    float flux_0, flux_p, flux_q;           // Ω Y0, Ω Y1 p, Ω Y1 q
    float flux_pp, flux_qq;                 // Ω p², Ω q²
    float flux_product_pq, flux_product_qq; // Ω Yxy p q, Ω Yxy q²
    float lobe_p, lobe_q;
};

// Uniform block "lpv_grid".
struct lpv_params {
    vec3s origin_m; // corner of cell 0, world space
    float cell_m;
    int32_t cells_x, cells_y, cells_z;                            // in use
    int32_t dim;                                                  // side of the images
    AG_STRUCT(lpv_reprojection) far_face, side_face, corner_face; // struct lpv_step
    float lobe_along, lobe_square, lobe_product;                  // struct lpv_lobe_weights
    // Intensity of a cell that only the environment lights, in the grid's unit; 0: none.
    vec3s sky[9];
    float fixed_from_flux;    // integer per scaled lumen
    float grid_from_fixed;    // the grid's unit per integer
    float irradiance_scale;   // scaled lux per ∫ intensity · (cosine)₊ dω in the grid's unit
    float mean_path;          // mean path of light in a step, cells
    float offset_m;           // of a surface's lookup, along the normal
    float bounce_offset;      // of a reflecting surface's lookup, cells of this cascade
    float window_1, window_2; // weights of bands 1 and 2 in a lookup, relative to a clamped cosine
    float injected_1;         // band 1 of injected light
    float staircase;          // 1: sides of cells approximate slopes by stairs (six neighbours)
    float occlusion;          // factor on the occlusion of the geometry volume
    float damping;            // of irradiance that decreases along the normal
    uint32_t rsm_size;        // texels
    uint32_t width, height;   // of the frame, pixels
    uint32_t emitter_count;
    uint32_t boundary; // LPV_OPEN sides whose outermost cells keep the coarser cascade's light
};

// Push constants of refine.comp.
struct lpv_refine_push {
    vec3s first;                       // corner of cell 0, in cells of the coarser cascade
    float ratio;                       // cells of the coarser cascade per cell
    int32_t cells_x, cells_y, cells_z; // of the coarser cascade
};

// Push constants of apply.comp.
struct lpv_apply_push {
    // World-space boxes: positions that this cascade lights, and those that finer ones light alone.
    vec3s low_m, high_m;
    vec3s finer_low_m, finer_high_m;
    uint32_t coarsest; // 1: nothing is before it in the images
    uint32_t has_dielectric;
    int32_t rows; // of pixels, of an invocation: columns.glsl
};

// Views of debug.comp.
#define LPV_VIEW_INJECTED   0
#define LPV_VIEW_PROPAGATED 1
#define LPV_VIEW_CELLS      2
#define LPV_VIEW_GEOMETRY   3

struct lpv_view_push {
    uint32_t view;
    float radiance_scale; // scaled cd/m² per flux of a cell in the grid's unit
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct lpv_reprojection) == 9 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_params) == 82 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_refine_push) == 7 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_apply_push) == 15 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_view_push) == 8, "layout is shared with GLSL");
#endif

#endif
