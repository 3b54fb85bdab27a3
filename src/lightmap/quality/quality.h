// The quality of a light map, for a report: density, overlaps, charts, seams, leaks and noise. It
// is measured in the finished map, with rays among the surfaces.
#pragma once

#include "bake/report.h"
#include "lightmap/close.h"
#include "lightmap/tracing.h"

enum { QUALITY_WORST = 10 };

// Light of two texels, or of the lookups at a seam, that differs.
struct quality_step {
    float step;     // difference over the larger light
    float before;   // of a seam: the same before it was closed
    float light[2]; // luminance, lux
    vec3s position; // world
    uint32_t chart[2];
    bool back;
};

// The largest steps, the largest first, each of another place.
struct quality_steps {
    struct quality_step at[QUALITY_WORST];
    int count;
};

// Charts in a class of densities or sizes.
struct quality_class {
    uint32_t charts;
    double amount; // their area in m², or texels
};
enum {
    DENSITY_CLASSES = 12, // from 1/8 of the reached density on, two for each factor of 2; the first
                          // and the last one are open
    SIZE_CLASSES = 24     // texels: 1, 2 to 3, 4 to 7, …; the last one is open
};

struct quality_charts {
    float wanted;        // texels per metre; 0: a number of texels was
    float *density;      // [charts] texels per metre; 0: in a single-texel chart
    float least, median; // density, of the surface's area
    uint32_t unwrapped, single_texel;
    uint32_t dark; // inside geometry as a whole
    struct quality_class densities[DENSITY_CLASSES], sizes[SIZE_CLASSES];
};

struct quality_overlaps {
    uint32_t shared; // texels that several charts touch
    uint32_t folded; // texels whose middle several triangles of one chart cover
};

// Points along the edges that two charts share, weighted by length; without those inside geometry.
struct quality_seams {
    float *before; // [places of the closing] luminance, lux
    double texels; // length of all seams
    struct quality_seam_state {
        double mean, largest; // step
        double above;         // share of the length with a step above QUALITY_SEAM_STEP
    } closed, unclosed;
    struct quality_steps worst;
};
#define QUALITY_SEAM_STEP 0.05f

// Two neighbouring texels of a chart leak if they lie in one plane, a surface divides at least half
// of the segments between their sample points, and their light differs by QUALITY_LEAK_STEP and by
// three standard errors: a bilinear lookup there has light of both sides of the surface.
struct quality_leaks {
    float *step; // [side_texel_count] the largest to a neighbour; 0: none
    uint32_t texels;
    struct quality_steps worst;
};
#define QUALITY_LEAK_STEP 0.25f

// Noise of the light of paths, without a filter. A unit is a chart, or several small ones
// (noise.h).
struct quality_noise {
    bool known;
    float largest, median; // of the units
    int count;
    struct quality_noisy {
        float noise;
        uint32_t chart, charts, texels;
        bool back;
    } worst[QUALITY_WORST];
};

struct lightmap_quality {
    struct host *host;
    float least_light; // luminance, lux: darker light counts as that
    struct quality_charts charts;
    struct quality_overlaps overlaps;
    float *open;             // [side_texel_count] share of a texel's points outside geometry
    uint32_t filled, partly; // texels with none outside geometry, and with some
    struct quality_seams seams;
    struct quality_leaks leaks;
    struct quality_noise noise;
};
// Before the seams are closed. quality_finish accepts zero.
bool quality_begin(struct lightmap_quality *out, const struct lightmap *map,
                   const struct seam_closing *closing);
// After it. wanted: density, texels per metre, 0: not given.
bool quality_measure(struct lightmap_quality *quality, const struct lightmap *map,
                     const struct seam_closing *closing, const struct lightmap_tracing *tracing,
                     float wanted);
void quality_finish(struct lightmap_quality *quality);

// Members of an open object. scene: names of instances and meshes.
void quality_report(struct report *report, const struct lightmap_quality *quality,
                    const struct lightmap *map, const struct scene *scene);

// Values of the texels of a side, one channel; NaN where there is none. *out is zero before.
enum quality_layer {
    QUALITY_CHART,   // its number
    QUALITY_DENSITY, // texels per metre
    QUALITY_OPEN,    // share of its points outside geometry
    QUALITY_NOISE,   // standard error over the light; NaN: not by paths
    QUALITY_LEAK     // step
};
bool quality_layer(const struct lightmap_quality *quality, const struct lightmap *map,
                   enum quality_layer layer, enum lightmap_side side, struct image *out);
