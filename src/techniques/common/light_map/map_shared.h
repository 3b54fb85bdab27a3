// Data of the passes that make and show a light map. Scalar layout.
#ifndef AG_LIGHT_MAP_MAP_SHARED_H
#define AG_LIGHT_MAP_MAP_SHARED_H

#include "core/shared.h"

#include "techniques/common/light_map/surface_shared.h"

#define LIGHT_MAP_LOCAL    64 // workgroup size over texels and places
#define LIGHT_MAP_LOCAL_2D 8  // over pixels of the debug view

// Tables are images of this width (table.h).
#define LIGHT_MAP_TABLE_WIDTH 4096u

// Parts of a texel in the table of texels: entry part · texels + texel.
#define TEXEL_POSITION    0 // world, m; w: area, m²; 0: the texel is inside geometry
#define TEXEL_NORMAL      1 // unit, of its side; w: roughness, if it is needed
#define TEXEL_SHADING     2 // mean shading normal, of length 1 or less
#define TEXEL_REFLECTANCE 3 // by colour
#define TEXEL_SKY_LIGHT   4 // irradiance along the normal, vector irradiance: radiance 1
#define TEXEL_EMITTED_0   5 // the same by colour, lux
#define TEXEL_FLUENCE     8 // of emissive surfaces by colour, lux; w: the sky's per irradiance
#define TEXEL_PARTS       9

// Words of 16 bytes of a texel in the table of shares of the environment's patches, a byte each:
// entry word · texels + texel. They sum to 255, or 0.
#define TEXEL_SKY_WORDS 4

// A texel that a wall divides has two words: the line across it, normal · p = offset with p from
// the texel's centre in texels, as 8, 8 and 16 bits snorm; and for each side of the line and
// quarter of the texel 4 bits, 2 for each axis (trace/texels/walls.h): 0: a lookup stays, else it
// is at the centre of the texel at this less 2 from its own. Bits of a quarter, and of a side:
#define LIGHT_MAP_WALL_QUARTER 4
#define LIGHT_MAP_WALL_SIDE    16

// First-order light besides that of punctual lights and the sky.
struct light_map_sources {
    float emitters;     // factor of the light of emissive surfaces
    uint32_t painted;   // 0: no texel has paint, and another table is bound for it
    uint32_t sky_words; // TEXEL_SKY_WORDS; 0: the environment is uniform
};

// Painted irradiance of a texel (paint.h).
struct light_map_painted {
    uint32_t texel;
    vec3s lux;
};

// Entries of a sum of texels side by side in a texel of its table: (texel, weight).
#define LIGHT_MAP_PAIR 2

struct light_map_paint_push {
    uint32_t count;
};

struct light_map_emission_push {
    uint32_t texels, columns;
    uint32_t fluence; // 0: there are no rows of it
};

struct light_map_rows_push {
    uint32_t first, count;
};

// Passes over rows `first` … `first` + `count` − 1. texels: of the light. layers: of a side, of the
// light and of the image that they write.
struct light_map_show_push {
    uint32_t first, count, texels, layers;
};

struct light_map_seams_push {
    uint32_t first, count, places, pairs, texels, layers; // pairs: of a row
};

struct light_map_apply_push {
    float per_width, per_height;           // 1 / size of the light map
    float per_view_width, per_view_height; // 1 / size of the view
    AG_STRUCT(light_map_instances) instances;
};

struct light_map_checker_push {
    AG_STRUCT(light_map_instances) instances;
};

// Specialization constants: the size of a workgroup; pixels of an invocation, which are in a
// column, at most 32 (columns.glsl); whether there is FRAME_DIELECTRIC; whether the environment has
// a map.
#define LIGHT_MAP_APPLY_WIDTH      66
#define LIGHT_MAP_APPLY_HEIGHT     67
#define LIGHT_MAP_APPLY_ROWS       68
#define LIGHT_MAP_APPLY_DIELECTRIC 2
#define LIGHT_MAP_APPLY_MIRRORS    3

#ifndef AG_GLSL
_Static_assert(sizeof(struct light_map_sources) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_painted) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_paint_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_emission_push) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_rows_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_show_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_seams_push) == 24, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_apply_push) == 24, "layout is shared with GLSL");
_Static_assert(sizeof(struct light_map_checker_push) == 8, "layout is shared with GLSL");
#endif

#endif
