// A BSDF whose directions are sampled by a mixture of its own lobes and the guide's distribution
// (Müller, Gross & Novák 2017, sec. 3.3).
//
// The guide replaces samples of the diffuse lobe alone: a narrow specular lobe is not what the
// distribution of a cell, which knows no viewer, approximates.
#pragma once

#include "trace/bsdf.h"
#include "trace/guide.h"

struct guided_bsdf {
    struct bsdf bsdf;
    const struct guide_cell *cell; // NULL: no guide
    float share;                   // of guided samples
};

// The share of the guided samples in a cell of that weight.
static inline float guided_share(const struct bsdf *bsdf, float weight)
{
    return weight * (1.0f - bsdf->specular_probability);
}

static inline struct guided_bsdf guided_bsdf_of(const struct bsdf *bsdf, const struct guide *guide,
                                                vec3s position)
{
    struct guided_bsdf g = { .bsdf = *bsdf, .cell = guide_find(guide, position, bsdf->normal) };
    if (g.cell && g.cell->nodes) g.share = guided_share(bsdf, g.cell->weight);
    return g;
}

static inline vec3s guided_sample(const struct guided_bsdf *g, float choice, vec2s u)
{
    if (choice < g->share) return guide_sample(g->cell, u);
    return bsdf_sample(&g->bsdf, (choice - g->share) / (1.0f - g->share), u);
}

// The density of guided_sample, from that of the BSDF's samples.
static inline float guided_pdf(const struct guided_bsdf *g, vec3s direction, float bsdf_pdf)
{
    if (!(g->share > 0.0f)) return bsdf_pdf;
    return bsdf_pdf + g->share * (guide_pdf(g->cell, direction) - bsdf_pdf);
}
