// Operators of a level: those of the dictionary in the frames of the blocks, with what objects
// inside blocks change and add (objects/clutter_operators.h). The struct owns all of its matrices;
// the run time uploads them (gpu/upload.h).
#pragma once

#include "techniques/mrt/level/level.h"

// Operators of blocks with the same openings. n texels of mrt_block_shape(resolution).
struct mrt_block_basis {
    struct matrix_f32 t_db; // k_b × n
    // By measure: n × k_b; 4 n × k_b, in the frame of mrt_point, empty: no irradiance by normal;
    // 9 p³ × k_b, probes in the frame of the cell, empty: none.
    struct matrix_f32 u[MRT_MEASURES];
    struct matrix_f32 l_imp; // n × k_b; the run time does not read it
};

// Response of a block to the light of an opening, at the 6 n² texels of a closed cube, 0 on that
// face; of a tube, at its n² texels.
struct mrt_block_response {
    struct matrix_f32 u[MRT_MEASURES]; // 6 n² × k_r, 24 n² × k_r, 9 p³ × k_r
};

// Light of a block in the coefficients of an opening.
struct mrt_pair {
    int source;             // the block
    struct matrix_f32 of_b; // T_b→r, transposed: k_b × k_r; empty: none of its walls
    struct matrix_f32 of_c; // T_c→r, transposed: faces of its clutter × k_r; empty: none of them
};

// A face of the clutter of a block: one of the r-coefficients of the opening that is clutter.
struct mrt_opening_face {
    int slot;                     // which
    int first_texel, texel_count; // in mrt_clutter.texels
    vec3s reflectance;            // mean
};

// Light enters a block: by an opening, or from the faces of the clutter in it, whose radiosity is
// r.
struct mrt_opening {
    int block;
    int face;     // −1: clutter
    int response; // of mrt_operators.responses
    struct mrt_pair *pairs;
    int pair_count;
    struct mrt_opening_face *faces; // of clutter, else NULL
    int face_count;
    struct matrix_f32 at_clutter; // rows of the block's mrt_clutter_rows × k_r
};

// Light of a block at the texels of its clutter, four values each (objects/delta.h).
struct mrt_clutter_rows {
    int block, first_texel, texel_count; // in mrt_clutter.texels
    struct matrix_f32 u_b;               // texel_count · 4 × k_b
};

struct mrt_operators {
    struct host *host;
    int k_b, k_r;
    int probes;                    // p, along an edge of a block; 0: none
    struct mrt_block_basis *bases; // room for two of each block
    int basis_count;
    int *basis_of_block;
    struct mrt_block_response *responses; // the first MRT_RESPONSES by mrt_response_of
    int response_count;
    struct mrt_opening *openings; // in the order of their blocks, clutter after those of its block
    int opening_count;
    // Parts of clutter.
    int clutter_count; // openings that are clutter
    // By block: the start of its voxels (objects/delta.h), 0: all of its probes are visible;
    // then the voxels. NULL: none has any.
    uint32_t *sight;
    size_t sight_count;
    struct mrt_clutter_rows *rows; // of the light map of clutter
    int row_count;
    uint32_t *map_source; // [places of the map] in mrt_clutter.texels; CHART_NONE: none
};

// mrt_operators_finish accepts zero and half-built.
bool mrt_operators_init(struct mrt_operators *out, struct host *host,
                        const struct mrt_level *level);
void mrt_operators_finish(struct mrt_operators *operators);

// Pairs with T_b→r.
size_t mrt_pair_count(const struct mrt_operators *operators);
// Rows of the light map of clutter in a block; NULL: none.
const struct mrt_clutter_rows *mrt_rows_of(const struct mrt_operators *operators, int block);

// ---- rotated.c: operators of the dictionary's shapes in the frames of blocks

// Texels and probes of `from`, rotated by to_from, are those of `to`.
struct mrt_rotation {
    struct mrt_shape from, to;
    mat3s to_from;
};

// Rows of light for each quantity of a measure.
static inline int mrt_values_of(enum mrt_measure measure)
{
    static const int values[MRT_MEASURES] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    return values[measure];
}

// Rows of light at the texels, or at p³ probes. Openings of `from` stay 0.
bool mrt_rotate_light(struct host *host, const struct mrt_rotation *turn, int p,
                      enum mrt_measure measure, const struct matrix_f32 *from,
                      struct matrix_f32 *out);
// Columns of the texels.
bool mrt_rotate_columns(struct host *host, const struct mrt_rotation *turn,
                        const struct matrix_f32 *from, struct matrix_f32 *out);
