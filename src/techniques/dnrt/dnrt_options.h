// Options of the technique.
#pragma once

#include "core/option.h"

enum { DNRT_SIZE_16, DNRT_SIZE_32, DNRT_SIZE_64 };
enum { DNRT_COEFFICIENTS_4, DNRT_COEFFICIENTS_9 };
enum { DNRT_BITS_16, DNRT_BITS_8 };

struct dnrt_options {
#define OPTION OPTION_FIELD
#include "techniques/dnrt/dnrt_options.def"
#undef OPTION
};

// Samples along an edge of a volume, and the bands of its coefficients.
static inline int dnrt_size(const struct dnrt_options *options)
{
    return 16 << options->size;
}

static inline int dnrt_bands(const struct dnrt_options *options)
{
    return options->coefficients == DNRT_COEFFICIENTS_4 ? 2 : 3;
}

static inline int dnrt_coefficients(const struct dnrt_options *options)
{
    return dnrt_bands(options) * dnrt_bands(options);
}
