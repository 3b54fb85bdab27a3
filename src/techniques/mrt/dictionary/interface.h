// Light through interfaces, the openings by which blocks connect (Loos 2015, sections 3.4.1 and
// 4.2): from the radiosity in the block that light leaves, to the lightfield of the interface, to
// the interfaces further on, and to the surfaces and probes of the block that light enters.
//
// In the frame of the interface (lightfield.h) light leaves the unit cube centred at (0, 0, −½) and
// enters the one at (0, 0, ½), or the tubes in these cells. Functions fill the rows of a range, so
// that they can run as tasks.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/lightfield.h"
#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/dictionary/shape.h"

// Lightfields at the opening `face` of a shape, in the frame of that face (cube.h), of radiosity at
// its texels: rows first_sample … of H_lf.
bool mrt_lightfield_of_surfaces(struct host *host, struct mrt_lightfield l,
                                const struct mrt_shape *shape, int face,
                                const struct matrix_f32 *radiosity, size_t first_sample,
                                struct matrix_f32 *out);

// The exits of a block, seen in the direction of travel. MRT_ROLL is not an exit: it turns the
// frame by a quarter from u to v, for three-dimensional mazes.
enum mrt_turn { MRT_STRAIGHT, MRT_TURN_LEFT, MRT_TURN_RIGHT, MRT_TURN_UP, MRT_TURN_DOWN, MRT_ROLL };
enum { MRT_TURNS_2D = 3, MRT_TURNS_3D = 6 };

// Rotation from the frame of the exit to that of the entry.
mat3s mrt_entry_from_exit(enum mrt_turn turn);
// The frame of light that enters by a face: that of the face, rotated by 180° around v.
mat3s mrt_block_from_entry(int face);
// The number of MRT_ROLLs from one frame to another with the same z; −1: z differs.
int mrt_rolls_between(mat3s from, mat3s to);
// The turn from one face of a block to another, and the number of MRT_ROLLs after it that lead to
// the exit's own frame.
struct mrt_passage {
    enum mrt_turn turn;
    int rolls;
};
struct mrt_passage mrt_passage_between(int entry_face, int exit_face);

// A hole is known by the share of each part (i, j) of its face that is open, at i + j · MRT_HOLES:
// u from i / MRT_HOLES, v from j / MRT_HOLES on.
enum { MRT_HOLES = 4, MRT_HOLE_PARTS = MRT_HOLES * MRT_HOLES };

// The mrt_entered_shape of light that enters a shape by a face.
int mrt_entered_by(const struct mrt_shape *shape, int face);

// Lightfields at the exit of lightfields at the entry (samples × columns). A round lightfield
// passes the tube of that turn, others a cube.
bool mrt_propagate(struct host *host, struct mrt_lightfield l, enum mrt_turn turn,
                   const struct matrix_f32 *entry, size_t first_sample, struct matrix_f32 *out);

// Light at a point of mrt_entered_shape that comes through the interface: adds to
// rows[q * samples + sample] for the quantities q of `rays`.
void mrt_gather_interface(struct mrt_lightfield l, const struct mrt_shape *entered,
                          struct mrt_point point, const struct mrt_rays *rays, float *rows);
