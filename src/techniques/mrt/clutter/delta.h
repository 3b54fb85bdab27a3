// Delta operators of blocks with clutter (Loos 2015, section 5.3), by rays in the block's cell that
// meet clutter on their way to a wall.
//
// Light is radiosity in (lm/m²) and irradiance out (lux), as in the dictionary: irradiance is the
// mean, over cosine-distributed rays, of the radiosity where they end. b is the radiosity L_imp b
// of walls, c that of faces of clutter. With the share V of rays to a wall texel that no clutter
// blocks, the irradiance of a point is Σ V L_imp b + Σ (1 − V) c, so
//     ΔU_b = −Σ over blocked rays of w L_imp at the wall behind the clutter,
//     ΔU_c = Σ over blocked rays of w, into the column of the face that is hit first, from either
//            side,
// w being a ray's weight (dictionary/rays.h): by normal and at probes the same with their weights.
// Light of an opening has no L_imp: it is scaled by the share of its rays that are not blocked.
#pragma once

#include "core/linalg.h"
#include "trace/trace.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/clutter/clutter.h"
#include "techniques/mrt/level/wall.h"

#include <stdatomic.h>

// Changes of the operators by clutter, at the points of a block: texels of its walls, or probes.
struct mrt_delta {
    struct matrix_f32 b;     // points · values × k_b: ΔU_b ≤ 0 for light ≥ 0
    struct matrix_f32 c;     // points · values × faces of the block: ΔU_c
    float *kept[CUBE_FACES]; // of each point, by opening: the share of rays that pass
    bool *closed;            // all rays are blocked: no light of walls and openings arrives
    bool *inside;            // most rays meet backs of clutter: the point is inside an object
};

struct mrt_delta_block {
    struct host *host;
    bool touched; // some ray is blocked; else the operators are 0
    int first_face, face_count;
    struct mrt_delta of[MRT_MEASURES];
    uint32_t *sight; // probe_sight.h; NULL: without probes
};

// Rays through a level that meet clutter: input of all of its operators, which are the same bits
// for any number of threads.
struct mrt_clutter_rays {
    const struct mrt_block_map *map;
    const struct matrix_f32 *const *l_imp; // of each block, in its frame: texels × k_b
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

// ---- delta_ray.c

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
