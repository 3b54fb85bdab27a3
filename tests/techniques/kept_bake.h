// Bakes that tests have in common.
#pragma once

#include "bake/bake.h"

// Runs a bake on all cores, or loads what an equal one wrote before, see test_bake_path. Not for
// tests of bakes.
bool kept_bake_run(struct bake *bake);
