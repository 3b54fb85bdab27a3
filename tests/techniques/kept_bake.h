// Bakes that tests have in common.
#pragma once

#include "bake/bake.h"

// Runs a bake on all cores, or loads what an equal one wrote before: in this process, or in all
// with the folder AFTERGLOW_TEST_BAKES, which ./check makes and removes. Not for tests of bakes.
bool kept_bake_run(struct bake *bake);
