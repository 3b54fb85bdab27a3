// The options of light propagation volumes, and what follows from them alone.
#pragma once

#include "core/vec.h"
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
