// Options of the technique.
#pragma once

#include "core/option.h"

enum { DNRT_SIZE_16, DNRT_SIZE_32, DNRT_SIZE_64 };
enum { DNRT_COEFFICIENTS_4, DNRT_COEFFICIENTS_9 };
enum { DNRT_BITS_16, DNRT_BITS_8 };
enum { DNRT_NORMALS_1, DNRT_NORMALS_3, DNRT_NORMALS_6 };
enum { DNRT_GRID_UNIFORM, DNRT_GRID_QUADRATIC };
enum { DNRT_OCCLUDED_IRRADIANCE, DNRT_OCCLUDED_RADIANCE };
enum { DNRT_INTRUSION_OFF, DNRT_INTRUSION_SHADOW };

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

// Volumes of a coefficient: m of red, green and blue, and k for light that is reflected alone.
static inline int dnrt_planes(const struct dnrt_options *options)
{
    return options->direct ? 4 : 3;
}

// Normals of receivers that a shape has a volume for.
static inline int dnrt_normals(const struct dnrt_options *options)
{
    static const int COUNT[] = { 1, 3, 6 };
    return COUNT[options->normals];
}
