// Operators of blocks with clutter (Loos 2015, section 5.3), by rays in the proportions of the
// block.
//
// Light is radiosity in (lm/m²) and irradiance out (lux), as in the dictionary: irradiance is the
// mean, over cosine-distributed rays, of the radiosity where they end. b is the radiosity L_imp b
// of walls, c that of faces of clutter. With the share V of rays to a wall texel that no clutter
// blocks, the irradiance of a point is Σ V L_imp b + Σ (1 − V) c, so
//     U_b + ΔU_b = Σ over rays that clutter does not block of w L_imp where they end,
//     ΔU_c = Σ over blocked rays of w, into the column of the face that is hit first, from either
//            side,
// w being a ray's weight (dictionary/rays.h): by normal and at probes the same with their weights.
// The same rays give T_d→b past clutter (weighted.c, level/projection.h).
// Light of an opening has no L_imp: it is scaled by the share of its rays that are not blocked.
#pragma once

#include "core/linalg.h"
#include "trace/trace.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/objects/clutter.h"
#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/wall.h"

#include <stdatomic.h>

// Changes of the operators by clutter, at the points of a block: texels of its walls, or probes.
struct mrt_delta {
    struct matrix_f32 b;       // points · values × k_b: U_b + ΔU_b
    struct matrix_f32 c;       // points · values × faces of the block: ΔU_c
    float (*kept)[CUBE_FACES]; // of each point, by opening: the share of rays that pass
    float *open;               // of each point: the share of rays that no clutter blocks
    bool *inside;              // most rays meet backs of clutter: the point is inside an object
};

struct mrt_delta_block {
    struct host *host;
    bool touched; // some ray is blocked; else the operators are 0
    int first_face, face_count;
    struct mrt_delta of[MRT_MEASURES];
    struct matrix_f32 t_db; // k_b × texels: T_d→b past clutter
    uint32_t *sight;        // probe_sight.h; NULL: without probes
};

// Rays through a level that meet clutter: input of all of its operators, which are the same bits
// for any number of threads.
struct mrt_clutter_rays {
    const struct mrt_block_map *map;
    const struct matrix_f32 *const *l_imp; // of each block, in its frame: texels × k_b
    const struct matrix_f32 *const *t_db;  // the same: k_b × texels
    int resolution;                        // of walls
    const struct mrt_clutter *clutter;
    const struct trace_scene *objects; // of the clutter alone
    int rays, probes;                  // per point, a power of two; along an edge, 0: none
    int depth;                         // openings that a ray passes at most
    const atomic_bool *stop;           // NULL, or ends the work early, as a failure
};

static inline bool mrt_is_stopped(const atomic_bool *stop)
{
    return stop && atomic_load_explicit(stop, memory_order_relaxed);
}

// mrt_delta_block_finish accepts zero.
bool mrt_delta_block_init(struct mrt_delta_block *out, struct host *host,
                          const struct mrt_clutter_rays *rays, int block);
void mrt_delta_block_finish(struct mrt_delta_block *delta);

// Faces of a block; returns their count.
int mrt_faces_of_block(const struct mrt_clutter *clutter, int block, int *first);

// Rows of points inside objects, on a grid of edge × edge × layers with `values` rows for each,
// become the mean of their valid neighbours', outward from these (section 5.4.2).
void mrt_inpaint(struct matrix_f32 *rows, int edge, int layers, int values, const bool *inside);

// ---- cell_ray.c
//
// Rays in the world, followed through the cells of blocks.

// The point of the cell of a block that is nearest to one of the world. False where the warp has no
// inverse there.
bool mrt_cell_of_point(const struct mrt_block_map *map, int block, vec3s world, vec3s *cell);
// The wall or opening where a ray of the world ends in the cell of a block, and the point in the
// world. False where the warp has no inverse.
bool mrt_cell_ray(const struct mrt_clutter_rays *rays, int block, vec3s from, vec3s way,
                  struct mrt_hit *hit, vec3s *end);

// The share of a ray that passes where it ends, and its face: 1 at an opening, that of the holes
// on a wall, which the wall keeps from it.
float mrt_passing_share(const struct mrt_block *block, const struct mrt_hit *hit, int *face);

// The frame whose third axis is the normal.
mat3s mrt_frame_of_normal(vec3s normal);

// The cell of a block, and the bounds of clutter in it: world; empty: there is none.
struct mrt_clutter_cell {
    const struct mrt_clutter_rays *rays;
    const struct mrt_block *block;
    int index;
    struct mrt_shape shape;
    struct box3 bounds;
};
struct mrt_clutter_cell mrt_clutter_cell_of(const struct mrt_clutter_rays *rays, int block);
// Whether clutter is on the segment between two points of the cell.
bool mrt_delta_blocked(const struct mrt_clutter_cell *cell, vec3s from, vec3s to,
                       struct trace_hit *hit);
// Bounds of a block, wider by more than the rounding of rays that run along its sides, and of a
// triangle of clutter.
struct box3 mrt_bounds_of_block(const struct mrt_block *block);
struct box3 mrt_bounds_of_triangle(const struct chart_triangle *triangle);

// ---- delta_gather.c
//
// Light of walls on faces of clutter (Loos 2015, section 5.3.3), as the mean irradiance of each
// face: the coefficients c of the next bounce.

// Irradiance of the faces of a block, of b of a source block.
struct mrt_gathered {
    int source;
    struct matrix_f32 of_b; // faces × k_b
};

struct mrt_gather_faces {
    struct host *host;
    struct mrt_gathered *from; // ascending sources
    int count;
    struct matrix_f32 of_c; // faces × all faces
};

// mrt_gather_faces_finish accepts zero. A face has at least as many rays as a texel.
bool mrt_gather_faces_init(struct mrt_gather_faces *out, struct host *host,
                           const struct mrt_clutter_rays *rays, int block);
void mrt_gather_faces_finish(struct mrt_gather_faces *gather);

// ---- delta_entry.c
//
// Changes of the light that enters a block by an opening, from clutter beyond it: walls that the
// clutter occludes (ΔT_b→r), and its own light (T_c→r).
//
// r-coefficients are those of the irradiance E that the response U_r has at the walls of a closed
// cube: U_r is orthonormal, so r = U_rᵀ E, with E by rays from these walls through the opening.
// Clutter of the block itself is left to the share of rays that it lets pass (delta.h).

struct mrt_delta_source {
    int block;
    bool hidden;         // clutter hides some of its walls
    struct matrix_f32 b; // k_r × k_b: T_b→r, with clutter
    struct matrix_f32 c; // k_r × faces of the block: T_c→r
};

struct mrt_delta_entry {
    struct host *host;
    struct mrt_delta_source *sources; // as of the opening
    int count;
};

// The opening of a block that light enters by, its response, and the blocks that send it.
struct mrt_entered_opening {
    int block, face;
    const struct matrix_f32 *u_r;
    const int *sources;
    int source_count;
};

// mrt_delta_entry_finish accepts zero.
bool mrt_delta_entry_init(struct mrt_delta_entry *out, struct host *host,
                          const struct mrt_clutter_rays *rays,
                          const struct mrt_entered_opening *opening);
void mrt_delta_entry_finish(struct mrt_delta_entry *entry);

// ---- clutter_transfer.c
//
// Transfer of light to the texels of a block's clutter (Loos 2015, section 5.3.3: C_b), for the
// light map of clutter.
//
// A texel has four values: the linear SH of irradiance by normal, in the world's frame, that fit
// the hemisphere around the surface's normal as OHLSH do (appendix B), and at that normal are the
// irradiance. Light that enters by an opening is that of the probes around the texel, scaled by the
// share of its rays to the opening that no clutter blocks.

struct mrt_clutter_transfer {
    struct host *host;
    int block;
    uint32_t first_texel; // in clutter->texels
    size_t texel_count;
    struct matrix_f32 b;       // texels · 4 × k_b
    struct matrix_f32 c;       // texels · 4 × faces of the block
    float (*kept)[CUBE_FACES]; // of each texel, by opening
    bool *inside;              // of each texel: it is inside another object
};

// A block without faces has no texels. mrt_clutter_transfer_finish accepts zero.
bool mrt_clutter_transfer_init(struct mrt_clutter_transfer *out, struct host *host,
                               const struct mrt_clutter_rays *rays, int block);
void mrt_clutter_transfer_finish(struct mrt_clutter_transfer *transfer);

// Light of an opening at the texels, texels · 4 × k_r, from that of its probes: p³ · 9 × k_r in
// the frame of the cell.
bool mrt_clutter_transfer_response(const struct mrt_clutter_transfer *transfer, struct host *host,
                                   const struct mrt_clutter_rays *rays, int face,
                                   const struct matrix_f32 *probes, struct matrix_f32 *out);

// ---- probe_sight.c
//
// Visibility of probes from the places of a block past its clutter, for lookups between probes.
//
// A grid of voxels over the cell. A voxel has a bit for each of the eight probes around it, that of
// the corner x + 2 y + 4 z: all of the voxel sees the probe. Its part in a solid does not count.
// If no probe is visible, the light of all eight is scaled by the share of directions without
// clutter, in 1/255: it is 0 in a closed object.

enum {
    MRT_SIGHT_VOXELS = 16,
    // Bits of a voxel; shaders have their own (mrt_shared.h).
    MRT_VOXEL_PROBES = 0xff,
    MRT_VOXEL_OPEN = 8, // from this bit on
    MRT_VOXEL_SOLID = 1 << 16,
};

// Voxels along an edge, at least MRT_SIGHT_VOXELS: the probes around all points of one are the
// same.
static inline int mrt_sight_edge(int p)
{
    return 2 * p * ((MRT_SIGHT_VOXELS + 2 * p - 1) / (2 * p));
}

// mrt_sight_edge³ voxels, x fastest. The same bits for any number of threads.
void mrt_probe_sight(const struct mrt_clutter_cell *cell, uint32_t *voxels);

// ---- weighted.c

// Changes T_d→b (k_b × texels) so that direct light of texels that clutter hides has no part in it.
// share: of each texel's rays, those that no clutter blocks.
bool mrt_weigh_projection(struct host *host, const struct matrix_f32 *l_imp, const float *share,
                          struct matrix_f32 *t_db);
