// The stages of the bake: see bake/README.md of the project's src/bake.
#pragma once

#include "techniques/technique.h"

bool dnrt_bake(struct bake_plan *plan, const struct technique_bake *how);
