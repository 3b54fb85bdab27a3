// Options of precomputed radiance transfer.
#pragma once

#include "core/option.h"

struct prt_options {
#define OPTION OPTION_FIELD
#include "techniques/prt/prt_options.def"
#undef OPTION
};

enum { PRT_UNSHADOWED, PRT_SHADOWED, PRT_INTERREFLECTED };

static inline int prt_bands(const struct prt_options *options)
{
    return 2 + options->coefficients;
}
// Coefficients of a function over the sphere.
static inline uint32_t prt_coefficients(const struct prt_options *options)
{
    return (uint32_t)(prt_bands(options) * prt_bands(options));
}
