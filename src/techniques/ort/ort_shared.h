// Data of the passes. Scalar layout.
#ifndef AG_ORT_SHARED_H
#define AG_ORT_SHARED_H

#include "core/shared.h"

#include "techniques/common/light_map/map_shared.h"

// Texels of a row that an invocation of the gather handles: those whose halves of one colour are a
// texel of 16 bytes in a table. Pieces of maps begin and end at multiples of it.
#define ORT_RUN 8

// Bins are square atlases of this side in texels, on the GPU columns of runs: the run of column s
// and row y is three texels, by colour, of row s from 3 · y on.
#define ORT_BIN_SIDE 1024

#define ORT_LOCAL 64 // workgroup size over texels and places

// Light in pairs, since runs of it begin at any x: for each colour the halves of the texels x and
// x + 1, from x = −ORT_MARGIN to width + ORT_MARGIN − 1, at the texel (y, x + ORT_MARGIN); a layer
// for each level.
#define ORT_MARGIN (ORT_RUN - 1)

// Levels of prefiltered light: level 0 is the light of single texels (levels.h).
#define ORT_LEVELS 4

// Weights are mostly far below 1, where half floats are coarse: maps have them times this.
#define ORT_MAP_SCALE 4096.0f

// Specialization constants of the gather: the rows of a workgroup; pieces are slices.
#define ORT_GATHER_ROWS   0
#define ORT_GATHER_SLICES 2
// And of the finish: all light of a texel, its own too, scatters below the surface.
#define ORT_FINISH_SCATTERS 3

struct ort_direct_push {
    uint32_t texels;
    int32_t shadow_radius; // texels of the shadow map
    AG_STRUCT(light_map_sources) sources;
};

struct ort_spread_push {
    uint32_t width, height;
};

struct ort_level_push {
    uint32_t width, height, stride; // of the taps, texels
    int32_t level;
};

// A workgroup has a list of the pieces that its rows have in the column: (first, count) in the
// entries. `lists`: those before the part's.
struct ort_gather_push {
    uint32_t width, height, lists;
    uint32_t more; // 1: adds to the sums of the parts before
};

struct ort_finish_push {
    uint32_t texels, height;
    AG_STRUCT(light_map_sources) sources;
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct ort_direct_push) == 20, "layout is shared with GLSL");
_Static_assert(sizeof(struct ort_spread_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct ort_level_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct ort_gather_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct ort_finish_push) == 20, "layout is shared with GLSL");
#endif

#endif
