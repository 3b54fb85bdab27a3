// The processes that run a command together, as afterglow-mpi starts them.
#pragma once

#include <afterglow/bake.h>

struct team {
    struct ag_bake_team ranks;
    int threads; // of this process, where --threads does not say
};
