// Coefficients of the faces of clutter, in an order that leaves few that are zero.
#pragma once

#include "techniques/mrt/runtime/clutter/delta_operators.h"

// Faces that send light to clutter of their block come first, then those that send some to walls or
// openings; others lose their coefficient, as their c lights nothing: no ray from a texel, a probe
// or a face meets the underside of a box on a floor.
bool mrt_order_faces(struct mrt_delta_operators *operators);
