// Light of emissive surfaces is linear in the radiance of each material: a bake has columns of
// light for radiances of 1, and at run time they are weighted by the materials' emission.
#pragma once

#include "core/host.h"
#include "scene/pose.h"

enum { EMISSION_COLUMNS = 16 };

struct emission_column {
    int material; // −1: of the materials that share columns
    int channel;  // of its radiance; −1: of each, for a material without an emissive map
};

// The columns of light of a material, one after another; those of a map and shared ones are of the
// channels of its radiance.
struct emission_part {
    int first, count; // count 0: it does not emit
    bool shared;      // their weights are 1: the light is that of the material's emission
    float unit;       // factor of the emission in the scene of a bake
};

struct emission_basis {
    struct host *host;
    struct emission_column columns[EMISSION_COLUMNS];
    int count;
    int material_count;
    struct emission_part *parts; // [material_count]
    int shared;                  // materials that share columns
};

// Columns of the emissive materials of the pose's instances: in the order of the scene, as long as
// there are columns, and three shared ones for all others. Depends on which materials emit, not on
// how much. Units: in the scene of a bake, each material with columns of its own, and all shared
// ones together, emit about the same power, so that samples of emitters are spread over the
// columns.
bool emission_basis_init(struct emission_basis *out, struct host *host,
                         const struct scene_pose *pose);
void emission_basis_finish(struct emission_basis *basis); // accepts zero

// Rows of a tensor: without columns there is one, of zeros.
static inline uint64_t emission_basis_rows(const struct emission_basis *basis)
{
    return basis->count > 0 ? (uint64_t)basis->count : 1;
}

// The emission of a material in the scene of a bake.
vec3s emission_basis_unit(const struct emission_basis *basis, const struct scene *scene,
                          int material);
// Weights of the columns by colour, cd/m²: light of colour c is Σ weight[column].c · column.
void emission_basis_weights(const struct emission_basis *basis, const struct scene *scene,
                            vec3s weights[EMISSION_COLUMNS]);
