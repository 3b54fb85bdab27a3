// A level as input of the run time: its blocks, its light map, its geometry image and the operators
// of the dictionary, in the frames of the blocks.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/level/atlas.h"
#include "techniques/mrt/clutter/clutter_light.h"
#include "techniques/mrt/level/probes.h"
#include "techniques/mrt/level/published.h"
#include "techniques/mrt/level/area_light.h"
#include "techniques/mrt/level/wall.h"

// Operators of blocks with the same openings. n texels of mrt_block_shape(resolution).
struct mrt_basis_input {
    unsigned open;
    struct matrix_f32 t_db; // k_b × n
    // By measure: n × k_b; 4 n × k_b, in the frame of mrt_point, empty: no irradiance by normal;
    // 9 p³ × k_b, probes in the frame of the cell, empty: none.
    struct matrix_f32 u[MRT_MEASURES];
    struct matrix_f32 l_imp; // n × k_b; the run time does not read it
};

// Response of a block to the light of an opening, at the 6 n² texels of a closed cube, 0 on that
// face; of a tube, at its n² texels.
struct mrt_response_input {
    struct matrix_f32 u[MRT_MEASURES]; // 6 n² × k_r, 24 n² × k_r, 9 p³ × k_r
};

// Light of a block that enters another one through an opening of that one: T_b→r.
struct mrt_pair_input {
    int opening, source; // of mrt_runtime_input.openings; a block
    const float *t_br;   // transposed: k_b rows of k_r, t_br_stride apart
};

// Light enters a block: by an opening, or from the faces of the clutter in it, whose radiosity is
// r.
struct mrt_opening_input {
    int block;
    int face;     // −1: clutter
    int response; // of mrt_runtime_input.responses
};

// A face of the clutter of a block: one of its r-coefficients.
struct mrt_clutter_face_input {
    int opening, slot;            // of mrt_runtime_input.openings; which of its r-coefficients
    int first_texel, texel_count; // in mrt_clutter_input.texels
    vec3s reflectance;            // mean
};

// Light of a block at the texels of its clutter, four values each (clutter/clutter_transfer.h).
struct mrt_clutter_rows_input {
    int block, first_texel, texel_count;   // in mrt_clutter_input.texels
    struct matrix_f32 u_b;                 // texel_count · 4 × k_b
    struct matrix_f32 u_r[CUBE_FACES + 1]; // × k_r, of the openings of the block
};

// The light map of clutter; rows NULL: there is none.
struct mrt_clutter_atlas_input {
    const struct mrt_clutter_rows_input *rows;
    int count;
    const uint32_t *source; // [places of the map] in mrt_clutter_input.texels; CHART_NONE: none
    const struct mrt_clutter *clutter; // charts, and triangles of the scene
};

// Light of the faces of a block in the coefficients of an opening: r, or the irradiance of faces.
struct mrt_face_pair_input {
    int opening, source;    // of mrt_runtime_input.openings; a block
    struct matrix_f32 of_c; // faces of the source × k_r
};

struct mrt_clutter_input {
    const struct mrt_clutter_texel *texels;
    int texel_count;
    const struct mrt_clutter_face_input *faces;
    int face_count;
    const int *openings; // those that are clutter
    int opening_count;
    const struct mrt_face_pair_input *pairs; // in the order of their openings
    int pair_count;
    struct mrt_clutter_atlas_input atlas;
};

struct mrt_runtime_input {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    const struct mrt_scene_images *images;
    int k_b, k_r;
    int probes; // p, along an edge of a block; 0: none
    const struct mrt_basis_input *bases;
    int basis_count;
    const int *basis_of_block;
    const struct mrt_response_input *responses;
    int response_count;
    const struct mrt_opening_input *openings; // in the order of their blocks
    int opening_count;
    const struct mrt_pair_input *pairs; // in the order of their openings
    int pair_count, t_br_stride;
    const struct mrt_clutter_input *clutter; // NULL: none
    // By block: the start of its voxels (clutter/probe_sight.h), 0: all of its probes are visible;
    // then the voxels. NULL: none has any.
    const uint32_t *sight;
    size_t sight_count;
    const struct mrt_published *published; // NULL: none
};
