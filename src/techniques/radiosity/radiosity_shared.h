// Data of the light map that the host uploads for the shaders of radiosity. Scalar layout.
#ifndef AG_RADIOSITY_SHARED_H
#define AG_RADIOSITY_SHARED_H

#include "core/shared.h"

#define RADIOSITY_LOCAL    64 // workgroup size over texels and clusters
#define RADIOSITY_LOCAL_2D 8  // over pixels and texels of the map, in x and y

// Layers of the light map for one side of the surfaces: one for each colour. A texel is the
// irradiance along the surface's normal, and the vector irradiance.
#define RADIOSITY_LAYERS 3

// An entry of a row: the node in the lower bits, above it the form factor as a half, of which the
// upper two bits are zero: it is below 2.
#define RADIOSITY_NODE_BITS 18

struct radiosity_gpu_texel {
    vec3s position; // world
    float area_m2;  // 0: hidden inside of something
    vec3s normal;   // unit, of its side
    vec3s reflectance;
    vec4s sky;        // irradiance along the normal, vector irradiance: of a sky of radiance 1
    vec4s emitted[3]; // the same by colour, lux
};

// Where a texel is sampled, and what it sees.
struct radiosity_gpu_point {
    vec3s position;         // world
    float inverse_distance; // mean over its rays, 1/m
    uint32_t place;         // in the light map: (side · height + y) · width + x
};

struct radiosity_gpu_cluster {
    vec3s reflectance;     // mean by area
    float area_m2;         // of texels that are not hidden
    uint32_t first, count; // in the list of members
};

// A node of the tree above the clusters.
struct radiosity_gpu_node {
    uint32_t first, count; // clusters; count 0: it is no source
};

// Where a triangle of the scene is in the light map: x = u · (position, 1), y = v · (position, 1),
// in texels.
struct radiosity_gpu_triangle {
    vec4s u, v;
    vec3s normal;   // unit, of the front
    uint32_t sides; // 0: it is not in the map; 1: its front is; 2: both are
};

// A texel's share of the light of a place beside a seam.
struct radiosity_gpu_seam {
    uint32_t texel;
    float weight;
};

// What debug views show of a texel.
struct radiosity_gpu_label {
    uint32_t place; // in the light map, as of points
    uint32_t chart, cluster;
    uint32_t state; // RADIOSITY_SAMPLED_…
};
#define RADIOSITY_SAMPLED_IN_MIDDLE 0
#define RADIOSITY_SAMPLED_BESIDE    1 // the middle is inside of something
#define RADIOSITY_NOT_SAMPLED       2 // all of it is

#define RADIOSITY_VIEW_CHARTS   0
#define RADIOSITY_VIEW_TEXELS   1
#define RADIOSITY_VIEW_CLUSTERS 2
#define RADIOSITY_VIEW_VALIDITY 3

struct radiosity_direct_push {
    uint32_t texels;
    int32_t shadow_radius; // texels of the shadow map
    float emitters;        // 1: emissive surfaces are sources, 0: they are not
};

struct radiosity_clusters_push {
    uint32_t clusters;
};

// Rows of clusters `first` … `first` + `count` − 1.
struct radiosity_solve_push {
    uint32_t first, count, entries; // entries: of a row
    float over;                     // relaxation factor
};

struct radiosity_nodes_push {
    uint32_t clusters, nodes;
};

// Rows of texels `first` … `first` + `count` − 1.
struct radiosity_gather_push {
    uint32_t first, count, entries;
    float emitters;
};

struct radiosity_smooth_push {
    uint32_t texels, width; // width: of the light map
};

struct radiosity_map_push {
    uint32_t width, height; // of the light map
};

struct radiosity_seams_push {
    uint32_t places, entries; // entries: of a row
    uint32_t width, height;   // of the light map
};

struct radiosity_apply_push {
    uint32_t width, height;
    uint32_t instances; // later ones are not in the map
    uint32_t has_dielectric;
};

struct radiosity_view_push {
    uint32_t width, height; // of the light map
    uint32_t instances;     // later ones are not in the map
    uint32_t view;          // RADIOSITY_VIEW_…
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct radiosity_gpu_texel) == 104, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_point) == 20, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_smooth_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_cluster) == 24, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_triangle) == 48, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_seam) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_seams_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_label) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_view_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_direct_push) == 12, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_clusters_push) == 4, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_solve_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gpu_node) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_nodes_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_gather_push) == 16, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_map_push) == 8, "layout is shared with GLSL");
_Static_assert(sizeof(struct radiosity_apply_push) == 16, "layout is shared with GLSL");
#endif

#endif
