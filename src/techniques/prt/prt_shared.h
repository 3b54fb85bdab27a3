// Data of the passes. Scalar layout.
#ifndef AG_PRT_SHARED_H
#define AG_PRT_SHARED_H

#include "core/shared.h"

#include "techniques/common/light_map/surface_shared.h"

#define PRT_MAX_COEFFICIENTS 25

// Bands and coefficients of the radiance that specular lobes reflect, by outgoing direction.
#define PRT_OUTGOING_BANDS 5
#define PRT_OUTGOING       25
// Roughness of the narrowest lobe of matrices: narrower ones have more detail than these bands.
#define PRT_LEAST_ROUGHNESS 0.3

#define PRT_LOCAL 64 // workgroup size over texels

// Transfer vectors of receivers, or rows of a codebook, in a table of eight halves: entry k · rows
// + row. With bounces it has coefficients 2k and 2k + 1, of each the direct one and by colour the
// bounced ones; without, the direct coefficients 8k … 8k + 7. Those beyond the last are 0.
#define PRT_VECTOR_HALVES 8

// Weights of receivers in a table of four halves: entry k · receivers + receiver.
#define PRT_ROW_HALVES 4

// Specialization constants: coefficients of a vector; whether it has bounces.
#define PRT_COEFFICIENTS 0
#define PRT_BOUNCES      1
// Vectors of a cluster's subspace.
#define PRT_VECTORS 2

// Whether vertices have light of emissive surfaces.
#define PRT_HAS_EMITTED 3

// Parts of a vertex in the table of vertices: entry part · vertices + vertex.
#define PRT_VERTEX_NORMAL    0 // unit, shading
#define PRT_VERTEX_EMITTED_0 1 // by colour: vector irradiance beside the normal; w: irradiance, lux
#define PRT_VERTEX_PARTS     4

// And in that of their light, as words of two halves: irradiance, normal, and if PRT_HAS_EMITTED
// the vector irradiance beside the normal by colour.
#define PRT_LIGHT_PARTS 2

// Uniform block "prt_light": coefficients of distant light, scaled radiance by colour.
struct prt_light {
    vec4s direct[PRT_MAX_COEFFICIENTS];  // of the environment
    vec4s bounced[PRT_MAX_COEFFICIENTS]; // and of suns, whose direct light the frame draws
};

struct prt_rows_push {
    uint32_t rows;
};

// Outgoing radiance towards the camera. rows: of the codebook, or texels.
struct prt_reflect_push {
    uint32_t texels, rows;
    float emitters;
    uint32_t coefficients; // of distant light
};

struct prt_light_push {
    uint32_t texels;
    float emitters; // factor of the light of emissive surfaces
};

struct prt_vertex_push {
    float per_view_width, per_view_height; // 1 / size of the view
    uint32_t vertices, triangles;          // triangles: of the scene
    AG_STRUCT(light_map_instances) instances;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct prt_light) == 2 * PRT_MAX_COEFFICIENTS * 16, "layout is shared with "
                                                                          "GLSL");
_Static_assert(sizeof(struct prt_rows_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct prt_reflect_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct prt_light_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct prt_vertex_push) == 24, "layout is shared with GLSL");
#endif

#endif
