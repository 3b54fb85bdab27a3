// A rank of a team other than 0: runs the tasks that it is given.
#pragma once

#include "bake/run_state.h"

bool follow_run(struct bake *bake, const struct bake_run_options *options);
