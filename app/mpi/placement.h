// The processor cores of a rank.
#pragma once

// Before MPI_Init and any thread. Ranks of a node share its cores; mpirun binds each to one core,
// or to a socket, and thus leaves others idle. Where that is fewer than its share, this process may
// run on all that the system allows it. Returns its share.
int placement_share(void);
