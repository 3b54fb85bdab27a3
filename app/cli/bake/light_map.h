// afterglow bake --lightmap: the light map of a scene, as files.
#pragma once

#include "cli/session.h"

// Checks options, loads the scene, gathers the light and writes the folder.
enum status light_map_bake(const struct arguments *arguments);
// Options that are of no use without --lightmap.
enum status light_map_check_others(const struct arguments *arguments);
