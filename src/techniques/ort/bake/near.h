// Texels near to a point, by a grid of cells, and the light that scatters from them.
#pragma once

#include "techniques/ort/bake/profile.h"
#include "techniques/ort/ort_map.h"

enum { ORT_KERNEL_STEPS = 2048 };

// Profiles of the three colours by distance, in units of the scene; 0 beyond the reach.
struct ort_kernel {
    struct ort_profile profile[3];
    float mm;                              // in a metre of the scene
    float reach_m, steps_per_m;            // of all colours
    float per_m2[3][ORT_KERNEL_STEPS + 2]; // 1/m²
};
void ort_kernel_init(struct ort_kernel *out, const struct ort_options *options);
// Share per area of the light of a texel of this area that leaves at a distance from its middle,
// 1/m²: the mean over a square of the area, or at 0 over a disk.
void ort_kernel_at(const struct ort_kernel *kernel, float distance_m, float area_m2, float out[3]);

// A texel of a stretched chart, cut across its longer side into about square parts.
struct ort_strip {
    vec3s side; // from one part to the next
    int parts;  // odd: the middle one is at the centroid
};
// [charts->side_texel_count], owned by the caller. NULL: no memory.
struct ort_strip *ort_make_strips(struct host *host, const struct charts *charts);

struct ort_near_item {
    uint64_t cell;
    uint32_t texel;
};

// ort_near_finish accepts zero.
struct ort_near {
    struct host *host;
    struct ort_near_item *items; // by cell
    uint32_t count;
    vec3s origin;
    float per_cell; // 1/m
    uint64_t side[3];
};
// Cells are as wide as the reach of searches.
bool ort_near_init(struct ort_near *out, const struct ort_map *map, float reach_m);
void ort_near_finish(struct ort_near *near);
// Calls visit for all texels whose centroids are within the reach of a point, and for some beyond.
void ort_near_visit(const struct ort_near *near, vec3s position,
                    void (*visit)(void *user, uint32_t texel), void *user);
