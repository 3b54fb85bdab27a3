// Data of the light map that the host uploads for the shaders of radiosity. Scalar layout.
#ifndef AG_RADIOSITY_SHARED_H
#define AG_RADIOSITY_SHARED_H

#include "core/shared.h"

#include "techniques/common/light_map/map_shared.h"

#define RADIOSITY_LOCAL    64 // workgroup size over texels and clusters
#define RADIOSITY_LOCAL_2D 8  // over pixels, in x and y

// An entry of a row: the node, or the stratum of a texel's block, in the lower bits, above it the
// form factor as a half, of which the upper two bits are zero: it is below 2.
#define RADIOSITY_NODE_BITS 18

// Clusters of a group: their number is above the first one.
#define RADIOSITY_GROUP_SHIFT RADIOSITY_NODE_BITS

// Rows of a tile.
#define RADIOSITY_TILE 8

// Entries of rows side by side in a texel of a table: of texels two words each, of clusters one.
#define RADIOSITY_PAIR LIGHT_MAP_PAIR
#define RADIOSITY_QUAD 4

// Neighbours of a texel, in pairs of (texel, weight), of each pass of the smoothing.
#define RADIOSITY_NEIGHBOURS    8
#define RADIOSITY_SMOOTH_PASSES 2

// Debug data of a place of the light map: those of its nearest valid texel.
struct radiosity_gpu_label {
    uint32_t chart, cluster;
    uint32_t state; // RADIOSITY_SAMPLED_…
};
#define RADIOSITY_SAMPLED_IN_MIDDLE 0
#define RADIOSITY_SAMPLED_BESIDE    1 // the middle is inside geometry
#define RADIOSITY_NOT_SAMPLED       2 // all of it is
#define RADIOSITY_FILLED            3 // it is the light of another texel
#define RADIOSITY_NO_TEXEL          4

#define RADIOSITY_VIEW_CHARTS   0
#define RADIOSITY_VIEW_CLUSTERS 1
#define RADIOSITY_VIEW_VALIDITY 2

// Passes over rows `first` … `first` + `count` − 1: of texels, clusters or places.
struct radiosity_direct_push {
    uint32_t first, count, texels;
    int32_t shadow_radius; // texels of the shadow map
    AG_STRUCT(light_map_sources) sources;
};

struct radiosity_clusters_push {
    uint32_t clusters;
};

struct radiosity_solve_push {
    uint32_t first, count;
    float over; // relaxation factor
};

struct radiosity_strata_push {
    uint32_t first, count;
};

struct radiosity_nodes_push {
    uint32_t groups;
};

struct radiosity_gather_push {
    uint32_t first, count, texels;
    float sharp; // factor of the light of emissive surfaces and of paint
    AG_STRUCT(light_map_sources) sources;
};

struct radiosity_smooth_push {
    uint32_t first, count, texels, pass;
    float sharp; // as of radiosity_gather_push
    AG_STRUCT(light_map_sources) sources;
};

struct radiosity_view_push {
    AG_STRUCT(light_map_instances) instances;
    uint32_t width, height; // of the light map
    uint32_t view;          // RADIOSITY_VIEW_…
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct radiosity_gpu_label) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_view_push) == 20, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_direct_push) == 28, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_clusters_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_solve_push) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_nodes_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gather_push) == 28, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_smooth_push) == 32, "layout is shared with GLSL");
#endif

#endif
