// What the shaders of light propagation volumes share with the host. Scalar layout.
#ifndef AG_LPV_SHARED_H
#define AG_LPV_SHARED_H

#include "core/shared.h"

#define LPV_TEXELS                                                                                 \
    4 // side of the block of texels of a reflective shadow map that one invocation injects
#define LPV_EMITTERS_LOCAL                                                                         \
    64 // invocations of a workgroup that injects emissive surfaces, one point each
#define LPV_SURFACE_LINES                                                                          \
    4 // along each side of a cell's face; where one crosses a triangle its surface is sampled
#define LPV_SURFACE_UNIT 65536.0 // of reflectance × area, per cells²
#define LPV_RUN                                                                                    \
    8 // cells along z that an invocation of a step with 26 neighbours takes; divides every
      // dimension

#define LPV_MAX_CASCADES     4
#define LPV_OPEN(axis, high) (1u << (2 * (axis) + (high))) // a side of a grid, in a set of them
#define LPV_TRANSITION                                                                             \
    4.0 // cells before an open side over which a cascade gives way to the next coarser one

// Specialization constants.
#define LPV_CONSTANT_BANDS      0 // 2 or 3
#define LPV_CONSTANT_HALF       1
#define LPV_CONSTANT_GEOMETRY   2 // LPV_GEOMETRY_…
#define LPV_CONSTANT_NEIGHBOURS 3 // 6 or 26
#define LPV_CONSTANT_HELD       4 // send on what geometry holds back, not what it lets through
#define LPV_CONSTANT_CUBIC      5 // reconstruction between cells: cubic, or linear
#define LPV_CONSTANT_DAMPED     6 // light is looked up a cell further along the normal too

// What stands in the way of the light: nothing, what lights and camera see, or all of the scene.
#define LPV_GEOMETRY_OFF   0
#define LPV_GEOMETRY_MAPS  1
#define LPV_GEOMETRY_SCENE 2
#define LPV_LINES          4 // through a face, each way
#define LPV_WORDS_OF_6     3 // of a cell's shares, with six neighbours and with 26
#define LPV_WORDS_OF_26    9

// Faces that are alike: their direction is (p, q, 0) or (p, q, q) in some order of the axes, their
// solid angle Ω, the axis of the lobes they are re-projected as (lobe_p, lobe_q, …). See
// lpv_propagate.comp.
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
    int32_t cells_x, cells_y, cells_z;                   // in use; beyond them is the outside
    int32_t dim;                                         // side of the images
    AG_STRUCT(lpv_reprojection) ahead, beside, diagonal; // struct lpv_step
    float lobe_along, lobe_square, lobe_product;
    vec3s sky; // coefficient of band 0 that a cell under the sky alone has, in the grid's unit; 0:
               // none
    float fixed_from_flux;  // integer per scaled lumen
    float grid_from_fixed;  // the grid's unit per integer
    float irradiance_scale; // scaled lux per ∫ intensity · (cosine)₊ dω in the grid's unit
    float mean_way;         // of light in a step, cells
    float offset_m;         // of the look-up, along the normal
    float bounce_offset; // of the look-up of what surfaces send on, cells: that of the light that
                         // has arrived there
    float window;        // weight of the bands above the first at the look-up
    float blocking;      // factor on what the geometry volume says is blocked
    float damping;       // of light that is less a cell further along the normal
    uint32_t rsm_size;   // texels
    uint32_t width, height; // of the frame, pixels
    uint32_t emitter_count;
    uint32_t held; // sides whose outermost cells keep the light of the coarser cascade
};

// Where the next coarser cascade lies as seen from this one: lpv_refine.comp.
struct lpv_refine_push {
    vec3s first;                       // the corner of cell 0, in cells of the coarser
    float ratio;                       // cells of the coarser per cell
    int32_t cells_x, cells_y, cells_z; // of the coarser
};

// Which pixels a cascade lights: lpv_apply.comp.
struct lpv_apply_push {
    vec3s finer_origin_m; // of the next finer cascade
    float finer_cell_m;   // 0: there is none
    int32_t finer_cells_x, finer_cells_y, finer_cells_z;
    uint32_t finer_open;
    uint32_t open;     // this one's sides
    uint32_t coarsest; // there is none before it
};

// Views of lpv_debug.comp.
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
_Static_assert(sizeof(struct lpv_params) == 55 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_refine_push) == 7 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_apply_push) == 10 * 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct lpv_view_push) == 8, "layout is shared with GLSL");
#endif

#endif
