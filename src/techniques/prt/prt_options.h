// Options of precomputed radiance transfer.
#pragma once

#include "core/option.h"

struct prt_options {
#define OPTION OPTION_FIELD
#include "techniques/prt/prt_options.def"
#undef OPTION
};

enum { PRT_AT_TEXEL, PRT_AT_VERTEX };
enum { PRT_UNSHADOWED, PRT_SHADOWED, PRT_INTERREFLECTED };

// Rays of a transfer matrix, over the hemisphere.
static inline uint32_t prt_glossy_rays(const struct prt_options *options)
{
    enum { MOST_RAYS = 2048 };
    return options->rays < MOST_RAYS ? (uint32_t)options->rays : MOST_RAYS;
}
static inline int prt_bands(const struct prt_options *options)
{
    return 2 + options->coefficients;
}
enum { PRT_NONE, PRT_PCA, PRT_VQ, PRT_CPCA };

// Coefficients of a function over the sphere.
static inline uint32_t prt_coefficients(const struct prt_options *options)
{
    return (uint32_t)(prt_bands(options) * prt_bands(options));
}
static inline bool prt_has_bounces(const struct prt_options *options)
{
    return options->transfer == PRT_INTERREFLECTED;
}
// Numbers of a texel's transfer vector: with bounces for each coefficient the direct one, then the
// bounced ones by colour.
static inline uint32_t prt_dimension(const struct prt_options *options)
{
    return prt_coefficients(options) * (prt_has_bounces(options) ? 4 : 1);
}
// Coefficients of the radiance that arrives at a probe.
static inline uint32_t prt_probe_rows(const struct prt_options *options)
{
    enum { OF_IRRADIANCE = 9, OF_REFLECTIONS = 25 };
    return options->glossy ? OF_REFLECTIONS : OF_IRRADIANCE;
}
// Largest number of probes, about, without probe_spacing.
static inline uint64_t prt_probes_most(const struct prt_options *options)
{
    enum { TEXELS_PER_PROBE = 32 };
    return (uint64_t)options->texels / TEXELS_PER_PROBE;
}
// The codebook of compressed vectors; 0 clusters: there is none.
static inline uint32_t prt_clusters(const struct prt_options *options)
{
    if (options->compression == PRT_NONE) return 0;
    return options->compression == PRT_PCA ? 1 : (uint32_t)options->clusters;
}
static inline uint32_t prt_vectors(const struct prt_options *options)
{
    const uint32_t vectors = (uint32_t)options->vectors, dimension = prt_dimension(options);
    if (options->compression == PRT_VQ) return 0;
    return vectors < dimension ? vectors : dimension;
}
// Means and vectors of all clusters.
static inline uint32_t prt_codebook_rows(const struct prt_options *options)
{
    return prt_clusters(options) * (1 + prt_vectors(options));
}
