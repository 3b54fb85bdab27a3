// Messages between the ranks of MPI_COMM_WORLD. All calls are of the main thread, and none waits in
// MPI: its waiting takes a whole core.
#pragma once

#include "cli/bake/team.h"

// Between MPI_Init and MPI_Finalize. One at a time: MPI has one world.
void transport_begin(struct ag_bake_team *out);
// Tells the others that this process has ended, and why ("": it was not needed any longer); then
// waits until they have, so that MPI_Finalize does not. False: one has not within some seconds.
bool transport_end(const char *why);
