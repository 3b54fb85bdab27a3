// Light maps of static surfaces as images: irradiance of all bounces, for other engines. Rows of
// light for each texel, of a bake by the path tracer or of a technique's light map, become images
// whose gutters repeat the nearest texel of their chart.
#pragma once

#include "bake/bake.h"
#include "image/image.h"
#include "scene/charts/charts.h"

// ---- stages.c: light by the path tracer

#define LIGHTMAP_PUNCTUAL "texels/punctual" // F32 [texels of both sides][3], lux
// F32 [texels of both sides][LIGHTMAP_COLUMNS], lux; share of open points; variance of the
// luminance, lux².
#define LIGHTMAP_REST "texels/rest"
enum { LIGHTMAP_SHARE = 3, LIGHTMAP_VARIANCE, LIGHTMAP_COLUMNS };
// With a bound of noise: F32 [units of texels][3], noise, paths of a texel, texels (noise.h).
#define LIGHTMAP_NOISE "charts/noise"

enum { LIGHTMAP_LEAST_PATHS = 32 };
struct lightmap_bake {
    const struct scene_pose *pose; // outlives the bake
    int samples;                   // paths of a texel; with a bound of noise the most
    // With a bound at least LIGHTMAP_LEAST_PATHS samples.
    float noise; // bound of each chart's noise, 0…1; 0: none
    // The charts of static surfaces: the same for each call.
    bool (*charts)(const struct scene_pose *statics, const void *options, struct host *host,
                   const struct charts_search *begin, struct charts *out);
    const void *options;
};
// In the identity of the bake.
#define LIGHTMAP_NAME "lightmap"
enum { LIGHTMAP_VERSION = 6 };
// charts: those of the texels, which are valid while the plan is; NULL: not wanted.
bool lightmap_add_stages(struct bake_plan *plan, const struct lightmap_bake *how,
                         const struct charts **charts);

// ---- lightmap.c

enum lightmap_side { LIGHTMAP_FRONT, LIGHTMAP_BACK, LIGHTMAP_SIDES };

// Facts of a texel beside its light.
struct lightmap_texel {
    float open;     // share of its sample points outside geometry; 0: it is filled
    float light;    // luminance without direct light of punctual lights, lux
    float variance; // of it, before a filter, lux²; NaN: not by paths
};

struct lightmap {
    struct host *host;
    struct charts charts;
    struct lightmap_texel *texels;           // [side_texel_count]
    bool has_back;                           // some material is double-sided
    struct image irradiance[LIGHTMAP_SIDES]; // lux; v downwards as in glTF
};
// Takes the charts over, also on failure. lightmap_finish accepts zero.
bool lightmap_init(struct lightmap *out, struct charts *charts, const struct scene *scene);
void lightmap_finish(struct lightmap *map);

// [side_texel_count] the texel whose light each has: itself, or where it is filled the nearest open
// one. After lightmap_set_paths or _layers; owned by the caller, NULL without memory.
uint32_t *lightmap_sources(const struct lightmap *map);

// Divides the map into pages (charts.h). Texels keep the light that they have.
bool lightmap_set_pages(struct lightmap *map, const struct scene *scene, uint32_t side);

// World positions of a side's texels, m; NaN where there is none. *out is zero before.
bool lightmap_positions(const struct lightmap *map, enum lightmap_side side, struct image *out);

// punctual: with direct light of punctual lights. filter: see filter.h. FAIL_FORMAT: the tensors
// are not of these charts.
bool lightmap_set_paths(struct lightmap *map, const struct tensors *bake, bool punctual,
                        bool filter);
// Noise of a map by paths.
struct lightmap_noise {
    float paths;   // of a texel, in the mean
    float largest; // of all units of texels (noise.h); NaN: not estimated
    int units;     // 0: not estimated
    int above;     // the bound, with the most paths
    int quiet;     // below half of the bound by few paths, or without light
};
// samples, bound: of the bake.
bool lightmap_noise_read(const struct lightmap *map, const struct tensors *bake, int samples,
                         float bound, struct lightmap_noise *out);
// Light of a technique, for each side and colour an image of irradiance along the surface's normal
// and vector irradiance, times `scale`. punctual: direct light of punctual lights is added.
struct lightmap_layers {
    const float *at[LIGHTMAP_SIDES][3]; // [height][width][4]
    float scale;
};
struct lightmap_tracing;
bool lightmap_set_layers(struct lightmap *map, const struct lightmap_tracing *tracing,
                         const struct lightmap_layers *layers, bool punctual);
