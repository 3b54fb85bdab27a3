// Symmetry of tubes: a straight one stays the same when it is rotated around its axis, a bend when
// up and down or its begin and end are exchanged, and the right bend is the left one in a mirror.
// Rows of gather operators are therefore needed for some texels only.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/shape.h"

// A motion of a tube onto itself: texels move by `around` (straight), or are mirrored.
struct tube_motion {
    int around;
    bool up, ends;
};

// Texels of which no motion takes one to another, and those texels.
int tube_orbits(const struct mrt_shape *tube);
int tube_representative(const struct mrt_shape *tube, int orbit);
// The orbit of a texel, and the motion from its representative.
int tube_orbit_of(const struct mrt_shape *tube, int texel, struct tube_motion *motion);
int tube_moved_texel(const struct mrt_shape *tube, struct tube_motion motion, int texel);

// Rows of `values` per representative, over the texels, to those of a texel.
void tube_moved_rows(const struct mrt_shape *tube, struct tube_motion motion, int values,
                     const struct matrix_f32 *from, struct matrix_f32 *to);

// Lights of the prior of a bend, in the order of mrt_prior_lights, which the same motions take to
// each other: those that stand for the others, four for each.
int tube_light_orbits(void);
int tube_light_representative(int orbit);
// The motion i, 0 to 3, of a bend.
struct tube_motion tube_bend_motion(int i);

// The texel and the probe of a left bend that are those of a right one in the mirror, or the other
// way round.
int tube_mirrored_texel(const struct mrt_shape *tube, int texel);
int tube_mirrored_probe(int probes, int probe);
// The sign of coefficient i of irradiance by normal in the mirror: of four (OHLSH, in the frame of
// a texel) or of nine (SH, in the frame of the cell).
float tube_mirrored_sign(int values, int i);
