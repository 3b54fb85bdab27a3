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

struct mrt_delta_input {
    const struct mrt_block *block;
    int index; // of the block
    struct mrt_shape shape;
    const struct matrix_f32 *l_imp; // texels × k_b, in the frame of the block
    const struct mrt_clutter *clutter;
    const struct trace_scene *objects; // of the clutter alone
    struct box3 bounds;                // of clutter in the block, world; empty: there is none
    int rays, probes;                  // per point; along an edge, 0: none
    const atomic_bool *stop;           // NULL, or ends the work early, as a failure
};

static inline bool mrt_is_stopped(const atomic_bool *stop)
{
    return stop && atomic_load_explicit(stop, memory_order_relaxed);
}

// The same bits for any number of threads. mrt_delta_block_finish accepts zero.
bool mrt_delta_block_init(struct mrt_delta_block *out, struct host *host,
                          const struct mrt_delta_input *input);
void mrt_delta_block_finish(struct mrt_delta_block *delta);

// Faces of a block; returns their count.
int mrt_faces_of_block(const struct mrt_clutter *clutter, int block, int *first);

// Rows of texels inside objects become the mean of their valid neighbours' on the same wall,
// outward from these (section 5.4.2); rows of probes, of their neighbours'. `values` rows for each
// point.
void mrt_inpaint_texels(struct matrix_f32 *rows, int resolution, int walls, int values,
                        const bool *inside);
void mrt_inpaint_probes(struct matrix_f32 *rows, int p, const bool *inside);

// ---- delta_ray.c

// Whether clutter is on the segment between two points of the cell.
bool mrt_delta_blocked(const struct mrt_delta_input *input, vec3s from, vec3s to,
                       struct trace_hit *hit);
